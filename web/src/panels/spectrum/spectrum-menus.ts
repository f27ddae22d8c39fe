import { formatCount, formatShort } from "../../ui/format";

const TICKS = [512, 1024, 2048, 4096];
/** Shares of the whole band, which ends at half the sample rate. */
const BANDS = [20, 5, 1];

/** Lengths of the record. */
export const tickItems = () => TICKS.map((n) => ({ value: String(n), label: formatCount(n, "tick") }));

/** How far the band reaches. */
export const bandItems = (dtMs: number) =>
  BANDS.map((n) => ({ value: String(n), label: `to ${formatShort(0.5 / dtMs / n, "kHz")}` }));
