import type { RateReadout } from "../../api/types";
import { logAxis, paintAxes, type Range } from "../../picture/axes";
import type { LegendEntry } from "../../picture/legend";
import type { Box, Look, Pen } from "../../picture/pen";
import { paintDot, paintLine, paintRule, within } from "../../picture/traces";
import { formatIn, formatShort } from "../../ui/format";
import { DASHES, type Scheme, TRACE_COLOURS } from "../../ui/palette";
import { deviation, scatter, TERMS, valuesOf } from "./deviation";

const POINTS = 64;

/** Slot and dash of each curve. */
const LINES = {
  measured: { name: "Measured, with its standard error", slot: 1, dash: 0 },
  fitted: { name: "Fitted, and its terms", slot: 2, dash: 1 },
  true: { name: "The noise of the rate itself", slot: 0, dash: 2 },
} as const;

export const allanEntries = (scheme: Scheme): LegendEntry[] =>
  Object.values(LINES).map(({ name, slot, dash }) => ({
    name,
    colour: TRACE_COLOURS[scheme][slot],
    dashes: DASHES[dash],
  }));

/** The Allan deviation over the averaging time, both logarithmic: measured, fitted, and of the rate itself. */
export function paintAllan(pen: Pen, box: Box, { octaves, figures, from_s, to_s }: RateReadout, look: Look): void {
  const fitted = valuesOf(figures, "value");
  const truth = valuesOf(figures, "true");
  const taus = decades(octaves.length ? octaves.map((o) => o.tau_s) : [0.001, 1]);
  const deviations = decades(octaves.length ? octaves.map((o) => o.deviation_deg_h).filter((d) => d > 0) : [1, 1000]);
  const seconds = (tau: number) => (tau < 1 ? formatShort(tau, "s") : formatIn(tau, "s", 0));
  const plot = paintAxes(
    pen,
    box,
    logAxis(taus, "averaging time", seconds),
    logAxis(deviations, "deviation, deg/h", (value) => formatShort(value, "")),
    look,
  );
  const stroke = ({ slot, dash }: { slot: number; dash: number }) => ({
    colour: TRACE_COLOURS[look.scheme][slot],
    dashes: DASHES[dash],
  });
  const curve = (of: (tau: number) => number, [from, to]: Range, ink: Parameters<typeof paintLine>[4]) => {
    const along = Array.from({ length: POINTS + 1 }, (_, i) => from * (to / from) ** (i / POINTS));
    paintLine(pen, plot, along, along.map(of), ink);
  };
  within(pen, plot.field, () => {
    if (Object.keys(truth).length > 0)
      curve((tau) => deviation(truth, tau), taus, { ...stroke(LINES.true), width: 1.6 });
    for (const [letter, value] of Object.entries(fitted))
      curve((tau) => TERMS[letter](value, tau), taus, { ...stroke(LINES.fitted), dashes: [], width: 1, alpha: 0.55 });
    if (Object.keys(fitted).length > 0)
      curve((tau) => deviation(fitted, tau), [from_s, to_s], { ...stroke(LINES.fitted), width: 2.2 });
    const { colour } = stroke(LINES.measured);
    octaves.forEach(({ tau_s, deviation_deg_h: found, pairs }, i) => {
      const share = Math.min(0.9, scatter(i, pairs));
      const at = plot.x(tau_s);
      paintRule(pen, [at, plot.y(found * (1 - share))], [at, plot.y(found * (1 + share))], { colour, width: 1 });
      paintDot(pen, at, plot.y(found), 3, colour);
    });
  });
}

/** Whole decades about some values. */
function decades(values: readonly number[]): Range {
  const low = Math.floor(Math.log10(Math.min(...values)) + 1e-9);
  return [10 ** low, 10 ** Math.max(low + 1, Math.ceil(Math.log10(Math.max(...values)) - 1e-9))];
}
