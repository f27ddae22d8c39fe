import { useMemo, useState } from "react";
import { useScheme } from "../ui/use-canvas";
import { Legend } from "./legend-list";
import styles from "./line-chart.module.css";
import { type LinesShown, lineEntries, nearestPoint, paintLines } from "./paint-lines";
import { Painted } from "./painted";
import type { Box, Look, Pen } from "./pen";
import { fileStem } from "./picture";
import { PictureMenu } from "./picture-menu";

interface LineChartProps extends LinesShown {
  title: string;
}

/** Lines over two titled axes, with a legend; the pointer reads the nearest point. */
export function LineChart({ title, xLabel, yLabel, lines, xRange, yRange, yLimits }: LineChartProps) {
  const scheme = useScheme();
  const [read, setRead] = useState<string | undefined>(undefined);
  const paint = useMemo(
    () => (pen: Pen, box: Box, look: Look) =>
      paintLines(pen, box, { xLabel, yLabel, lines, xRange, yRange, yLimits }, look),
    [xLabel, yLabel, lines, xRange, yRange, yLimits],
  );
  const take = () => ({ title, stem: fileStem(title), height: 400, legend: lineEntries(lines, "light"), paint });
  return (
    <figure className={styles.chart}>
      <figcaption>
        {title}
        <output>{read}</output>
        <PictureMenu name={title} take={take} />
      </figcaption>
      <div className={styles.stage}>
        <Painted
          label={`${title}: ${yLabel} over ${xLabel}`}
          paint={paint}
          onPoint={(at, plot) => setRead(at && nearestPoint(lines, plot, at))}
        />
      </div>
      <Legend entries={lineEntries(lines, scheme)} />
    </figure>
  );
}
