import { linearAxis, type Plot, paintAxes } from "../../picture/axes";
import type { Box, Look, Pen } from "../../picture/pen";
import { CROSS, paintCross, within } from "../../picture/traces";
import { CANVAS, fontFor } from "../../ui/palette";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import type { Drawing } from "./behaviour-plot";
import { type Behaviour, type Sets, setsOf, setsWords } from "./sets";

const AIR = 1.12;
const LEAST_REACH = 3;
const SPARE: number[] = [5, 4];
/** Lines above and below a disc for its name. */
const LINES = [0, -1, 1, -2, 2];

/** A scale for both axes that holds every disc and the measured output. */
export function reachOf({ discs, measured }: Sets): { x: number; y: number; half: number } {
  const all = [...discs.map(({ x, y }) => ({ x, y, r: 1 })), { ...measured, r: 0.3 }];
  const ends = (of: (one: { x: number; y: number; r: number }) => [number, number]) => {
    const spans = all.map(of);
    return [Math.min(...spans.map(([low]) => low)), Math.max(...spans.map(([, high]) => high))];
  };
  const [left, right] = ends(({ x, r }) => [x - r, x + r]);
  const [low, high] = ends(({ y, r }) => [y - r, y + r]);
  const half = Math.max(LEAST_REACH, (AIR * Math.max(right - left, high - low)) / 2);
  return { x: (left + right) / 2, y: (low + high) / 2, half };
}

/** The behaviours as discs, filled where input and output belong to them, and the measured output as a cross. */
function paintSets(pen: Pen, box: Box, look: Look, sets: Sets): void {
  const { x: middleX, y: middleY, half } = reachOf(sets);
  const across = linearAxis([middleX - half, middleX + half], "output by the sine of the drive, in limits of the test");
  const up = linearAxis([middleY - half, middleY + half], "output by its cosine, in limits");
  const plot = paintAxes(pen, box, across, up, look, { isAlike: true });
  const radius = plot.x(1) - plot.x(0);
  const ink = CANVAS[look.scheme];
  within(pen, plot.field, () => {
    sets.discs.forEach(({ x, y, holds }, i) => {
      const colour = traceColour(hypothesisStyle(i), look.scheme);
      pen.beginPath();
      pen.arc(plot.x(x), plot.y(y), radius, 0, 2 * Math.PI);
      pen.fillStyle = colour;
      pen.globalAlpha = holds ? 0.55 : 0.14;
      pen.fill();
      pen.globalAlpha = 1;
      pen.strokeStyle = colour;
      pen.lineWidth = holds ? 2.4 : 1.4;
      pen.setLineDash(holds || radius < 10 ? [] : SPARE);
      pen.stroke();
      pen.setLineDash([]);
    });
    paintNames(pen, look, plot, sets, radius);
    const [x, y] = [plot.x(sets.measured.x), plot.y(sets.measured.y)];
    paintCross(pen, x, y, { colour: ink.panel, width: 6 });
    paintCross(pen, x, y, { colour: ink.text, width: 2.4 });
  });
}

/** Each name at the right or left of its disc, on the first free line. */
function paintNames(pen: Pen, look: Look, { field, ...plot }: Plot, { discs, measured }: Sets, radius: number): void {
  const height = look.fontSize + 3;
  const taken: { left: number; right: number; y: number }[] = [];
  pen.font = fontFor(look.fontSize, 1, 600);
  pen.textBaseline = "middle";
  pen.textAlign = "left";
  pen.fillStyle = CANVAS[look.scheme].text;
  const all = [...discs.map((disc) => ({ ...disc, far: radius })), { ...measured, name: "measured", far: CROSS }];
  for (const { name, x, y, far } of all) {
    const width = pen.measureText(name).width;
    const right = plot.x(x) + far + 5;
    const left = plot.x(x) - far - 5 - width;
    const free = LINES.flatMap((line) =>
      [right, left].map((at) => ({ left: at, right: at + width, y: plot.y(y) + line * height })),
    ).find(
      (one) =>
        one.left >= field.left &&
        one.right <= field.right &&
        !taken.some((other) => one.left < other.right && one.right > other.left && Math.abs(one.y - other.y) < height),
    );
    if (!free) continue;
    taken.push(free);
    pen.fillText(name, free.left, free.y);
  }
}

/** The sets as a drawing. */
export function drawSets(behaviours: readonly Behaviour[], verdict: number): Drawing | undefined {
  const sets = setsOf(behaviours);
  return (
    sets && {
      words: setsWords(behaviours, verdict),
      legend: [
        ...behaviours.map(({ words }, i) => ({
          name: words,
          colour: traceColour(hypothesisStyle(i), "light"),
          mark: "field" as const,
        })),
        { name: "cross: the output measured", colour: CANVAS.light.text, mark: "cross" },
      ],
      paint: (pen, box, look) => paintSets(pen, box, look, sets),
    }
  );
}
