import type { Marks } from "../../bench/marks";
import type { UnitScale } from "../../ui/unit-scale";
import type { Envelope } from "./envelope-path";
import type { PlotTrace } from "./scope-options";

/** All that a scope shows at a moment, to be drawn elsewhere. */
export interface ScopePicture {
  traces: PlotTrace[];
  envelopes: Envelope[];
  /** Traces that are drawn as bands and not as signals. */
  bands: readonly number[];
  /** Of each column, in ms from the origin of the time axis. */
  times: Float64Array;
  units: string[];
  scales: UnitScale[];
  /** Of each unit's axis, in the unit of the signals. */
  ranges: { min: number; max: number }[];
  /** Ticks shown. */
  span: { start: number; end: number };
  /** Tick that the time axis calls zero. */
  origin: number;
  isTriggered: boolean;
  dtMs: number;
  marks: Marks;
}
