import { type BenchStore, useBench } from "./bench-store";

/** The state of the board: undefined before a bench is known, and while nothing has arrived for a second. */
const known = ({ connection, bench }: BenchStore) => (connection.staleSince ? undefined : bench?.state);

/**
 * Wall time since when nothing has arrived; undefined while the page is current.
 *
 * Panels, plots and bars ask here, so that all of them agree; none looks at the connection itself.
 */
export const useStaleSince = () => useBench((s) => s.connection.staleSince);

/** The state of the board as far as it is known now. */
export const useBoardState = () => useBench(known);

/** The moment from which the values on the page are, in words. */
export const staleWords = (since: Date): string => `stale since ${since.toLocaleTimeString()}`;
