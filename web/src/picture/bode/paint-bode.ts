import { formatShort } from "../../ui/format";
import { CANVAS, DASHES, type Scheme, TRACE_COLOURS } from "../../ui/palette";
import { decadeTicks } from "../../ui/ticks";
import { type Axis, linearAxis, logAxis, type Plot, paintAxes, type Range } from "../axes";
import type { LegendEntry } from "../legend";
import type { Box, Look, Pen } from "../pen";
import { paintBand, paintLine, paintPoints, paintRule, within } from "../traces";
import { type BodeBand, type BodeCurve, type BodePoints, dbRange } from "./bode-data";

export interface BodeShown {
  curves: BodeCurve[];
  band?: BodeBand;
  points?: BodePoints;
  /** The range of the phase. */
  degrees?: Range;
}

const WHOLE_TURN: Range = [-180, 0];
/** Of the height of both fields, for the magnitude. */
const UPPER = 0.62;

const bandColour = (scheme: Scheme) => `${CANVAS[scheme].accent}42`;

export function bodeEntries({ curves, points, band }: BodeShown, scheme: Scheme): LegendEntry[] {
  const colours = TRACE_COLOURS[scheme];
  return [
    ...curves.map(({ name, slot, dash }) => ({ name, colour: colours[slot], dashes: DASHES[dash] })),
    ...(points ? [{ name: points.name, colour: colours[points.slot], mark: "dot" as const }] : []),
    ...(band ? [{ name: band.name, colour: bandColour(scheme), mark: "field" as const }] : []),
  ];
}

/** Magnitude over phase, on one logarithmic axis of frequency; an upright line marks the reading. */
export function paintBode(pen: Pen, box: Box, shown: BodeShown, look: Look, read?: number): Plot {
  const { curves, band, points, degrees = WHOLE_TURN } = shown;
  const hertz = curves[0].hertz;
  const ends: Range = [hertz[0], hertz[hertz.length - 1]];
  const upper = Math.round((box.height - 3 * look.fontSize) * UPPER);
  const range = dbRange([...curves.flatMap((c) => c.db), ...(band?.db.high ?? []), ...(points?.db ?? [])]);
  const frequency = logAxis(ends, "frequency, Hz", (f) => formatShort(f, "Hz"), decadeTicks(...ends));
  const part = (height: number, of: "db" | "deg", x: Axis, y: Axis): Plot => {
    const colours = TRACE_COLOURS[look.scheme];
    const plot = paintAxes(pen, { width: box.width, height }, x, y, look, { gutter: look.fontSize * 2.3 });
    const { top, bottom } = plot.field;
    within(pen, plot.field, () => {
      if (band) paintBand(pen, plot, band.hertz, band[of].low, band[of].high, bandColour(look.scheme));
      for (const { slot, dash, ...curve } of curves)
        paintLine(pen, plot, curve.hertz, curve[of], { colour: colours[slot], dashes: DASHES[dash] });
      const errors = of === "db" ? points?.errorDb : undefined;
      if (points) paintPoints(pen, plot, points.hertz, points[of], colours[points.slot], errors);
      if (read === undefined) return;
      const at = plot.x(hertz[read]);
      paintRule(pen, [at, top], [at, bottom], { colour: CANVAS[look.scheme].event, width: 1, dashes: [3, 3] });
    });
    return plot;
  };
  part(upper, "db", { ...frequency, title: undefined, say: () => [] }, linearAxis(range, "magnitude re static, dB"));
  pen.save();
  pen.translate(0, upper);
  const plot = part(box.height - upper, "deg", frequency, turnAxis(degrees));
  pen.restore();
  return plot;
}

/** Angles by eighths of a turn, or quarters. */
function turnAxis(range: Range): Axis {
  const steps = [-180, -135, -90, -45, 0, 45, 90].filter((d) => d >= range[0] && d <= range[1]);
  return {
    ...linearAxis(range, "phase, °"),
    ticks: (count) => steps.filter((d) => count > steps.length - 1 || d % 90 === 0),
  };
}
