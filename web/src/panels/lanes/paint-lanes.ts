import { paintColumns, timeAxis } from "../../picture/axes";
import { eventAxis } from "../../picture/event-marks";
import type { Box, Look, Pen } from "../../picture/pen";
import { type Picture, pictureName } from "../../picture/picture";
import { fillSteps, within } from "../../picture/traces";
import { columnAt, largest, lowest } from "../../stream/panel-frame";
import { formatPercent } from "../../ui/format";
import { CANVAS, fontFor } from "../../ui/palette";
import type { TruthSwitch } from "./delays";
import type { LaneShown } from "./lane-canvas";
import { lanesLayout } from "./lanes-layout";
import { inkOf, paintBand, paintDelays, paintMarks, paintUnexplained, placesOf } from "./paint-bands";

export interface LanesShown extends LaneShown {
  switches: TruthSwitch[];
  names: string[];
  /** Names of the lanes: the hypotheses in words, or by name where words have no room. */
  labels: string[];
  /** Room for them, in sizes of the letters. */
  gutter: number;
  /** Whether the truth is among the signals, behind the verdict; not while a fault is hidden. */
  withTruth: boolean;
  /** Whether the signals end with the flag that no hypothesis fits. */
  withUnexplained: boolean;
  /** The sample that is explained. */
  picked: number | undefined;
}

/** Room for a lane and for the bands in a picture that is kept, px. */
const LANE_PX = 46;
const BANDS_PX = 100;

export const layoutOf = ({ width, height }: Box, { names, gutter }: LanesShown, { fontSize }: Look) =>
  lanesLayout(width, height, names.length, fontSize, gutter * fontSize);

/** Paint a bank: one filled lane per hypothesis, the guess hatched, the truth solid, the delay between them. */
export function paintLanes(ctx: Pen, box: Box, shown: LanesShown, look: Look): void {
  const { frame, span, names, hover } = shown;
  const { scheme, fontSize } = look;
  const layout = layoutOf(box, shown, look);
  const ground = { ...shown, ...look, layout };
  const colours = CANVAS[scheme];
  const colour = inkOf(look);
  const { columnX } = placesOf(ground);
  const reading = (signal: number) => (hover === undefined ? frame.latest[signal] : columnAt(frame, signal, hover));
  const winnerNow = reading(names.length);
  const truthNow = shown.withTruth ? reading(names.length + 1) : undefined;
  const field = { left: layout.left, right: layout.right, top: 0, bottom: layout.axis };

  paintColumns(ctx, field, timeAxis(span, frame.dtMs), look);
  within(ctx, field, () => {
    names.forEach((_, i) => {
      const { top, height } = layout.lanes[i];
      const base = top + height - 2;
      const tall = height - 4;
      for (const [part, alpha] of [
        [largest, "66"],
        [lowest, "d9"],
      ] as const) {
        ctx.fillStyle = colour(i) + alpha;
        fillSteps(ctx, part(frame, i), columnX, base, (value) => Math.max(1, value * tall));
      }
      ctx.fillStyle = colours.axis;
      ctx.fillRect(layout.left, base, layout.right - layout.left, 1);
    });
    paintBand(ctx, ground, largest(frame, names.length), layout.winner, false);
    const last = names.length + (shown.withTruth ? 2 : 1);
    if (shown.withUnexplained) paintUnexplained(ctx, ground, largest(frame, last));
    if (shown.withTruth) {
      paintBand(ctx, ground, largest(frame, names.length + 1), layout.truth, true);
      paintDelays(ctx, ground, lowest(frame, names.length));
    }
    paintMarks(ctx, ground);
  });
  ctx.textBaseline = "middle";

  names.forEach((_, i) => {
    const { top, height } = layout.lanes[i];
    const y = top + height / 2;
    ctx.font = fontFor(fontSize, 1, i === truthNow ? 700 : 450);
    ctx.fillStyle = i === truthNow || i === winnerNow ? colours.text : colours.muted;
    ctx.textAlign = "right";
    ctx.fillText(shown.labels[i], layout.left - 10, y);
    ctx.font = fontFor(fontSize, 1, i === winnerNow ? 700 : 450);
    ctx.fillText(formatPercent(reading(i)), layout.right + fontSize * 6, y);
  });
  ctx.font = fontFor(fontSize, 1, 450);
  ctx.fillStyle = colours.muted;
  ctx.fillText("verdict", layout.left - 10, layout.winner + layout.band / 2);
  if (!shown.withTruth) return;
  ctx.fillText("truth", layout.left - 10, layout.truth + layout.band / 2);
  ctx.fillText("delay", layout.left - 10, layout.delay + layout.band / 2);
}

/** The lanes of a diagnoser as a picture. */
export const lanesPicture = (shown: LanesShown, id: string): Picture => ({
  ...pictureName(`Diagnosis by ${id.replaceAll("_", " ")}`),
  up: "probability of each hypothesis, 0 to 1",
  height: LANE_PX * shown.names.length + BANDS_PX,
  time: eventAxis(shown, (box, look) => {
    const { left, right, axis } = layoutOf(box, shown, look);
    return { left, right, top: 0, bottom: axis };
  }),
  paint: (pen, box, look) => paintLanes(pen, box, { ...shown, hover: undefined, picked: undefined }, look),
});
