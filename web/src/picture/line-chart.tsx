import { useState } from "react";
import { useScheme } from "../ui/use-scheme";
import { useSize } from "../ui/use-size";
import { drawnSvg } from "./drawn-svg";
import styles from "./line-chart.module.css";
import { LineField, type LineFieldProps, lineColour, lineDashes } from "./line-field";
import type { Box } from "./pen";
import { PictureMenu } from "./picture-menu";
import { fileStem } from "./picture-name";
import type { SvgPen } from "./svg-pen";

interface LineChartProps extends Pick<LineFieldProps, "xLabel" | "yLabel" | "lines" | "xRange" | "yRange"> {
  title: string;
}

/** Lines over two titled axes, with a legend; the pointer reads the nearest point. */
export function LineChart({ title, ...chart }: LineChartProps) {
  const scheme = useScheme();
  const { element, size } = useSize<HTMLDivElement>();
  const [read, setRead] = useState<string | undefined>(undefined);
  const { lines, xLabel, yLabel } = chart;
  const label = `${title}: ${yLabel} over ${xLabel}`;
  const take = () => ({
    title,
    stem: fileStem(title),
    height: 400,
    legend:
      lines.length > 1
        ? lines.map(({ name }, i) => ({ name, colour: lineColour(i, "light"), dashes: lineDashes(i) }))
        : [],
    paint: (pen: SvgPen, box: Box) => pen.add(drawnSvg(<LineField label={label} {...chart} {...box} scheme="light" />)),
  });
  return (
    <figure className={styles.chart}>
      <figcaption>
        {title}
        <output>{read}</output>
        <PictureMenu name={title} take={take} />
      </figcaption>
      <div ref={element} className={styles.stage}>
        {size.width > 80 && <LineField label={label} {...chart} {...size} scheme={scheme} onRead={setRead} />}
      </div>
      {lines.length > 1 && (
        <ul className={styles.legend}>
          {lines.map((line, i) => (
            <li key={line.name}>
              <svg width="24" height="8" aria-hidden="true">
                <path
                  d="M0 4H24"
                  stroke={lineColour(i, scheme)}
                  strokeWidth="2.2"
                  strokeDasharray={lineDashes(i).join(" ")}
                />
              </svg>
              {line.name}
            </li>
          ))}
        </ul>
      )}
    </figure>
  );
}
