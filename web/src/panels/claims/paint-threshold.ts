import type { Claim, ClaimKnob, Threshold } from "../../api/types";
import { linearAxis, logAxis, type Plot, paintAxes } from "../../picture/axes";
import type { Box, Look, Pen } from "../../picture/pen";
import { fillHatched, paintDot, paintLine, paintRule, within } from "../../picture/traces";
import { formatShort } from "../../ui/format";
import { metricTitle } from "../../ui/metric-name";
import { CANVAS, fontFor } from "../../ui/palette";
import { unitText } from "../../ui/unit-scale";
import { roundRange } from "../scope/axis-range";

const FAINT = 0.28;
/** A bound farther than this many ranges of the measured values is not on the axis. */
const REACH = 1;

/** The figure of a claim over the range of a number: printed range hatched, expected range dashed, and the turns. */
export function paintThreshold(
  pen: Pen,
  box: Box,
  look: Look,
  { found, claim, knob, value }: { found: Threshold; claim: Claim; knob: ClaimKnob; value: number },
): Plot {
  const ink = CANVAS[look.scheme];
  const tried = found.tried.filter((one): one is typeof one & { measured: number } => one.measured !== null);
  const values = tried.map((one) => one.value);
  const figures = tried.map((one) => one.measured);
  const [low, high] = rangeOf(claim, figures);
  const title = unitText(knob.unit) ? `${knob.label}, ${unitText(knob.unit)}` : knob.label;
  const ends = [found.low, found.high] as const;
  const across =
    found.scale === "log" ? logAxis(ends, title, (tick) => formatShort(tick, "", 2)) : linearAxis(ends, title);
  const plot = paintAxes(pen, box, across, linearAxis([low, high], metricTitle(claim.metric)), look);
  const { field, x, y } = plot;
  within(pen, field, () => {
    if (claim.is_published) {
      const top = claim.printed_high === null ? field.top : Math.max(field.top, y(claim.printed_high));
      const bottom = claim.printed_low === null ? field.bottom : Math.min(field.bottom, y(claim.printed_low));
      pen.save();
      pen.globalAlpha = FAINT;
      if (bottom > top) fillHatched(pen, field.left, top, field.right - field.left, bottom - top, ink.accent);
      pen.restore();
    }
    const dashed = { colour: ink.muted, width: 1.6, dashes: [6, 4] };
    for (const bound of [claim.low, claim.high])
      if (bound !== null) paintRule(pen, [field.left, y(bound)], [field.right, y(bound)], dashed);
    paintLine(pen, plot, values, figures, { colour: ink.text, width: 2 });
    for (const one of tried) paintDot(pen, x(one.value), y(one.measured), 3, one.holds ? ink.accent : ink.alarm);
    paintRule(pen, [x(value), field.top], [x(value), field.bottom], { colour: ink.event, width: 2 });
  });
  pen.font = fontFor(look.fontSize, 1, 650);
  pen.textBaseline = "middle";
  found.turns.forEach((turn, i) => {
    const at = x(turn.value);
    paintRule(pen, [at, field.top], [at, field.bottom], { colour: ink.accent, width: 1.6, dashes: [2, 3] });
    const text = `${turn.begins ? "from" : "up to"} ${formatShort(turn.value, knob.unit === "1" ? "" : knob.unit)}`;
    const room = pen.measureText(text).width + 8;
    const isLeft = at + room > field.right || (!turn.begins && at - room > field.left);
    pen.textAlign = isLeft ? "right" : "left";
    pen.fillStyle = ink.accent;
    pen.fillText(text, at + (isLeft ? -6 : 6), field.top + look.fontSize * (0.9 + 1.3 * (i % 3)));
  });
  return plot;
}

/** The range of the measured values and of the bounds near them. */
function rangeOf(claim: Claim, measured: readonly number[]): [number, number] {
  const [low, high] = [Math.min(...measured), Math.max(...measured)];
  const room = REACH * Math.max(high - low, 1e-9 + 0.2 * Math.abs(high));
  const bounds = [claim.low, claim.high, claim.printed_low, claim.printed_high].filter((end) => end !== null);
  const near = bounds.filter((end) => end > low - room && end < high + room);
  const range = roundRange(Math.min(low, ...near), Math.max(high, ...near));
  return [range.min, range.max];
}
