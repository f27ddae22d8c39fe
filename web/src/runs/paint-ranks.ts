import { type Axis, linearAxis, type Plot, paintAxes, type Range } from "../picture/axes";
import type { Box, Look, Pen } from "../picture/pen";
import { paintDot, paintRule, within } from "../picture/traces";
import { CANVAS, TRACE_COLOURS } from "../ui/palette";

interface Rank {
  name: string;
  value: number;
  /** Half the length of its error bar. */
  spread?: number;
}

/** Named rows over one axis, the first on top. */
export interface RanksShown {
  label: string;
  span: Range;
  ranks: readonly Rank[];
  /** Bars from zero in place of dots; nearer to zero than this is chance. */
  chance?: number;
}

/** Half the height of a bar, in rows. */
const HALF = 0.28;

/** Bars from zero over the range of chance, or dots with error bars. */
export function paintRanks(pen: Pen, box: Box, { label, span, ranks, chance }: RanksShown, look: Look): Plot {
  const names: Axis = {
    range: [ranks.length, 0],
    ticks: () => ranks.map((_, i) => ranks.length - i - 0.5), // upward
    say: (ticks) => ticks.map((tick) => ranks[Math.floor(tick)]?.name ?? ""),
  };
  const plot = paintAxes(pen, box, linearAxis(span, label), names, look);
  const colour = TRACE_COLOURS[look.scheme][1];
  const { field, x, y } = plot;
  within(pen, field, () => {
    if (chance !== undefined) {
      pen.fillStyle = CANVAS[look.scheme].grid;
      pen.fillRect(x(-chance), field.top, x(chance) - x(-chance), field.bottom - field.top);
      paintRule(pen, [x(0), field.top], [x(0), field.bottom], { colour: CANVAS[look.scheme].axis, width: 1 });
    }
    ranks.forEach(({ value, spread = 0 }, i) => {
      if (chance === undefined) {
        const at = y(i + 0.5);
        paintRule(pen, [x(value - spread), at], [x(value + spread), at], { colour });
        paintDot(pen, x(value), at, 4, colour);
        return;
      }
      pen.fillStyle = colour;
      pen.fillRect(Math.min(x(0), x(value)), y(i + 0.5 - HALF), Math.abs(x(value) - x(0)), y(HALF) - y(-HALF));
    });
  });
  return plot;
}
