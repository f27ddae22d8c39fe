import type { Bench } from "../../api/types";
import { SvgPen } from "../../picture/svg-pen";
import { formatMoment, formatNumber } from "../../ui/format";
import { TRACE_COLOURS } from "../../ui/palette";
import type { Compared } from "./compared";
import type { ScopeShown } from "./paint-scope";
import { EDGE, HEIGHT, INK, paintFoot, paintTraces, WIDTH, wrapped, write } from "./slide-page";

const SIDE = 370;
/** Figures that have room beside the traces. */
const MOST = 3;

/** A change as a slide: its words, the live traces over the ghosts, and the figures before and after. */
export function changeSlide(
  words: string,
  tick: number,
  compared: Compared[],
  shown: ScopeShown,
  bench: Bench,
): string {
  const pen = new SvgPen();
  pen.textBaseline = "middle";
  write(pen, words, EDGE, 46, 34, 650, WIDTH - 2 * EDGE);
  const moment = `at ${formatMoment(tick * bench.dt_ms)} · ${bench.title}`;
  write(pen, moment, EDGE, 88, 20, 560, WIDTH - 2 * EDGE, INK.muted);
  paintTraces(pen, shown, { left: EDGE, top: 128, right: WIDTH - EDGE - SIDE, bottom: HEIGHT - 76 });

  const left = WIDTH - EDGE - SIDE + 34;
  const room = SIDE - 34;
  let y = 150;
  for (const { trace, measure, before, after, ratio } of compared.slice(0, MOST)) {
    write(pen, `${trace.name.replaceAll(/[._]/g, " ")}, ${measure}`, left, y, 20, 600, room, INK.muted);
    write(pen, `before ${before}`, left, y + 40, 28, 450, room);
    write(pen, `now ${after}`, left, y + 84, 40, 650, room, TRACE_COLOURS.light[trace.slot]);
    wrapped(pen, ratio, 24, room).forEach((line, i) => {
      write(pen, line, left, y + 126 + 30 * i, 24, 650, room);
    });
    y += 172;
  }
  paintFoot(pen, `CombBench · ${bench.scenario_id || bench.title} · ${formatNumber(bench.tick, 0)} ticks`);
  return pen.svg(WIDTH, HEIGHT, words);
}
