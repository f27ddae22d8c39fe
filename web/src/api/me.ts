import { create } from "zustand";
import { client, data } from "./client";
import type { Me } from "./types";

/**
 * A right: to change the bench on the page, to have several benches and the past of each, to use a server,
 * or to teach.
 */
export type Right = "drive" | "branch" | "server" | "teach";

/** A reader has a bench from a folder, with a worker in place of the server. */
export type Role = Me["role"] | "reader";

const RIGHTS: Record<Role, readonly Right[]> = {
  teacher: ["drive", "branch", "server", "teach"],
  student: ["drive", "server"],
  watcher: ["server"],
  reader: ["drive", "branch"],
};

interface MeStore {
  me: Me | undefined;
  /** The bench that the page shows. */
  at: string | undefined;
}

/** The person at this page; the page asks for it before it shows anything. */
export const useMe = create<MeStore>(() => ({ me: undefined, at: undefined }));

/** Whether the person at this page has a right; the server decides, and the page leaves out the controls that it would refuse. */
export function may(right: Right, role: Role | undefined = useMe.getState().me?.role): boolean {
  if (role === undefined || !RIGHTS[role].includes(right)) return false;
  return right === "server" || role !== "student" || !looksOn(useMe.getState());
}

/** Whether a student only watches the bench on the page: it is shown to all, and the student may not drive it. */
const looksOn = ({ me, at }: MeStore): boolean =>
  at !== undefined && at === me?.shown && at !== me.bench && at !== me.lent;

export const useMay = (right: Right): boolean => useMe(({ me }) => may(right, me?.role));

/** Whether a server is behind the page, as is assumed until the person is known. */
export const isServed = ({ me } = useMe.getState()): boolean => !me || may("server", me.role);

export const useServed = (): boolean => useMe(isServed);

/** Whether the page was opened by a link to watch, which shows one bench and nothing else of the server. */
export const useWatches = (): boolean => useMe(({ me }) => me?.role === "watcher");

/** Ask the server for the person at this page and for their bench. */
export async function askMe(): Promise<Me> {
  return keep(await data(client.GET("/api/v1/me")));
}

/** Raise a hand for the teacher to see, or take it down. */
export async function raiseHand(raised: boolean): Promise<Me> {
  return keep(await data(client.PUT("/api/v1/me/hand", { body: { raised } })));
}

/** The layout that the teacher gave to all last. */
export const givenLayout = () => data(client.GET("/api/v1/me/layout"));

/**
 * The bench to which a page goes: a bench just handed over or just shown to all, else the present one if it is still
 * allowed, else the own bench. Undefined: the page stays.
 */
export function placeOf(me: Me, before: Me | undefined, at: string | undefined): string | undefined {
  if (me.lent && me.lent !== before?.lent) return me.lent;
  if (me.shown && me.shown !== before?.shown) return me.shown;
  const here = at !== undefined && [me.bench, me.lent, me.shown].includes(at);
  return here ? undefined : (me.bench ?? undefined);
}

/** Answer the vote of one's class, or change one's answer. */
export async function castVote(vote: string, answer: number, at_ms: number | null): Promise<void> {
  await data(client.PUT("/api/v1/me/vote", { body: { vote, answer, at_ms } }));
  await askMe();
}

function keep(me: Me): Me {
  useMe.setState({ me });
  return me;
}
