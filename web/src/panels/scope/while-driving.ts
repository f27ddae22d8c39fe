import type { Driven } from "../../bench/driven";
import { type PanelFrame, tickOf } from "../../stream/panel-frame";
import type { Envelope } from "./envelope-path";

export const drove = (spans: readonly Driven[], tick: number): boolean =>
  spans.some(({ from, until }) => tick >= from && tick < until);

/** The signal of a controller while it drives; in shadow the device does not obey it. */
export function whileDriving({ low, high }: Envelope, frame: PanelFrame, spans: readonly Driven[]): Envelope {
  const drives = Array.from(low, (_, column) => drove(spans, tickOf(frame, column)));
  const only = (values: Envelope["low"]) => values.map((value, column) => (drives[column] ? value : Number.NaN));
  return { low: only(low), high: only(high) };
}
