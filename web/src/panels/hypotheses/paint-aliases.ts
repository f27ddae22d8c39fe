import type { AliasReport } from "../../api/types";
import { linearAxis, logAxis, paintAxes, type Range } from "../../picture/axes";
import type { Box, Look, Pen } from "../../picture/pen";
import { type Picture, pictureName } from "../../picture/picture";
import { paintDot, paintLine, paintRule, within } from "../../picture/traces";
import { formatSi } from "../../ui/format";
import { CANVAS, fontFor } from "../../ui/palette";
import { decadeTicks } from "../../ui/ticks";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";

/** Of the field, for the points and the noise about them. */
const SHARE = 0.62;
/** Distances below are as good as none, um. */
const LEAST_UM = 1e-7;
const DECADES = 5;
const BETWEEN = [3, 3];

const micrometres = (ticks: readonly number[]) => ticks.map((t) => formatSi(t, "um", 3));

/** The motion of every hypothesis at the drive frequency, as a point in the complex plane. */
export function paintPhasors(pen: Pen, box: Box, report: AliasReport, look: Look): void {
  const { map, sensor_noise_um: noise } = report;
  const ink = CANVAS[look.scheme];
  const points = map.responses.map(({ name, amplitudes_um: [a], phases_deg: [deg] }) => {
    const angle = (deg * Math.PI) / 180;
    return { name, x: a * Math.cos(angle), y: a * Math.sin(angle) };
  });
  const holding = (values: number[]): Range => {
    const middle = (Math.max(...values) + Math.min(...values)) / 2;
    const half = Math.max(Math.max(...values) - middle, 2 * noise, 1e-9) / SHARE;
    return [middle - half, middle + half];
  };
  const across = { ...linearAxis(holding(points.map((p) => p.x)), "real part of the motion"), say: micrometres };
  const up = { ...linearAxis(holding(points.map((p) => p.y)), "imaginary part"), say: micrometres };
  const { field, x, y } = paintAxes(pen, box, across, up, look, { isAlike: true, gutter: 4.2 * look.fontSize });
  const at = (name: string) => points.find((p) => p.name === name);
  within(pen, field, () => {
    for (const { first, second, coincident } of map.pairs) {
      const [a, b] = [at(first), at(second)];
      if (!coincident || !a || !b) continue;
      paintRule(pen, [x(a.x), y(a.y)], [x(b.x), y(b.y)], { colour: ink.alarm, width: 10, alpha: 0.5 });
    }
    pen.textAlign = "left";
    pen.textBaseline = "middle";
    points.forEach((point, i) => {
      const [px, py] = [x(point.x), y(point.y)];
      pen.strokeStyle = ink.event;
      pen.lineWidth = 1;
      pen.setLineDash(BETWEEN);
      pen.beginPath();
      pen.arc(px, py, Math.min(80, x(noise) - x(0)), 0, 2 * Math.PI);
      pen.stroke();
      pen.setLineDash([]);
      paintDot(pen, px, py, 5, traceColour(hypothesisStyle(i), look.scheme));
      pen.font = fontFor(look.fontSize, 1, 600);
      pen.fillStyle = ink.text;
      pen.fillText(point.name, px + 8, py + (i % 2 ? 9 : -9));
    });
    pen.font = fontFor(look.fontSize, 1);
    pen.fillStyle = ink.muted;
    const rings = `rings: noise of one sample, ${formatSi(noise, "um", 3)}`;
    pen.fillText(rings, field.left + 6, field.bottom - look.fontSize);
  });
}

/** Distance of the closest pair over the drive frequency. */
export function paintAliasSweep(pen: Pen, box: Box, report: AliasReport, look: Look): void {
  const { frequency_hz: hertz, distance_um } = report.sweep;
  const ink = CANVAS[look.scheme];
  const tone = report.map.tones_hz[0];
  const noise = Math.max(report.sensor_noise_um, LEAST_UM);
  const distance = distance_um.map((d) => Math.max(d, LEAST_UM));
  const high = Math.ceil(Math.log10(Math.max(...distance, noise)));
  const low = Math.max(high - DECADES, Math.floor(Math.log10(Math.min(...distance))));
  const ends = [hertz[0], hertz[hertz.length - 1]] as const;
  const across = logAxis(ends, "drive frequency", (f) => formatSi(f, "Hz", 1), decadeTicks(...ends));
  const up = logAxis([10 ** low, 10 ** high], "distance of the closest pair", (d) => formatSi(d, "um", 1));
  const { field, x, y } = paintAxes(pen, box, across, up, look);
  const upright = (hz: number, words: string, isLeft: boolean, stroke: Parameters<typeof paintRule>[3]) => {
    paintRule(pen, [x(hz), field.top], [x(hz), field.bottom], stroke);
    pen.textAlign = isLeft ? "right" : "left";
    pen.fillText(words, x(hz) + (isLeft ? -5 : 4), isLeft ? field.top + look.fontSize : field.bottom - look.fontSize);
  };
  within(pen, field, () => {
    pen.font = fontFor(look.fontSize, 1);
    pen.textBaseline = "middle";
    pen.fillStyle = ink.muted;
    paintRule(pen, [field.left, y(noise)], [field.right, y(noise)], { colour: ink.event, width: 1, dashes: BETWEEN });
    upright(report.f0_hz, "f₀", false, { colour: ink.axis, width: 1 });
    paintLine(pen, { x, y }, hertz, distance, { colour: ink.accent });
    if (tone > hertz[0]) upright(tone, "drive", true, { colour: ink.text });
  });
}

/** Which hypotheses coincide, as a picture. */
export function aliasPicture(report: AliasReport): Picture {
  return {
    ...pictureName("Motion of every hypothesis"),
    legend: report.map.responses.map(({ name }, i) => ({
      name,
      colour: traceColour(hypothesisStyle(i), "light"),
      mark: "dot",
    })),
    height: 420,
    paint(pen, box, look) {
      const half = { width: box.width / 2 - 10, height: box.height };
      paintPhasors(pen, half, report, look);
      pen.save();
      pen.translate(half.width + 20, 0);
      paintAliasSweep(pen, half, report, look);
      pen.restore();
    },
  };
}
