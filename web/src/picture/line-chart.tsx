import { useMemo } from "react";
import { Figure } from "./figure";
import { type LinesShown, lineEntries, nearestPoint, paintLines } from "./paint-lines";
import type { Box, Look, Pen } from "./pen";

interface LineChartProps extends LinesShown {
  title: string;
  /** The words of a point; its two numbers by default. */
  say?(line: number, point: number): string;
}

/** Lines over two titled axes, with a legend; the pointer reads the nearest point. */
export function LineChart({ title, say, xLabel, yLabel, lines, xRange, yRange }: LineChartProps) {
  const paint = useMemo(
    () => (pen: Pen, box: Box, look: Look) => paintLines(pen, box, { xLabel, yLabel, lines, xRange, yRange }, look),
    [xLabel, yLabel, lines, xRange, yRange],
  );
  return (
    <Figure
      title={title}
      label={`${title}: ${yLabel} over ${xLabel}`}
      height={250}
      paint={paint}
      read={(at, plot) => nearestPoint(lines, plot, at, say)}
      legend={(scheme) => lineEntries(lines, scheme)}
    />
  );
}
