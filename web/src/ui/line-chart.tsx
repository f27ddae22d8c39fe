import { useMemo, useState } from "react";
import { useScheme } from "../app/use-scheme";
import styles from "./line-chart.module.css";
import { DASHES, TRACE_COLOURS } from "./palette";
import { linearTicks } from "./ticks";
import { useSize } from "./use-size";

export interface ChartLine {
  name: string;
  x: readonly number[];
  y: readonly number[];
  /** Half the length of the bar at each point. */
  spread?: readonly number[];
  isStepped?: boolean;
}

interface LineChartProps {
  title: string;
  xLabel: string;
  yLabel: string;
  lines: readonly ChartLine[];
  xRange?: [number, number];
  yRange?: [number, number];
}

/** Room for the title of the upright axis, and for each digit of its numbers, px. */
const TITLE = 24;
const DIGIT = 7;
const RIGHT = 12;
const TOP = 8;
const BOTTOM = 40;

/** Lines over two titled axes, with a legend; the pointer reads the nearest point. */
export function LineChart({ title, xLabel, yLabel, lines, xRange, yRange }: LineChartProps) {
  const scheme = useScheme();
  const { element, size } = useSize<HTMLDivElement>();
  const [read, setRead] = useState<string | undefined>(undefined);
  const [x0, x1] = useMemo(() => xRange ?? spanOf(lines.flatMap((l) => l.x)), [lines, xRange]);
  const [y0, y1] = useMemo(
    () =>
      yRange ??
      spanOf(lines.flatMap((l) => l.y.flatMap((v, i) => [v - (l.spread?.[i] ?? 0), v + (l.spread?.[i] ?? 0)]))),
    [lines, yRange],
  );
  const height = Math.max(40, size.height - TOP - BOTTOM);
  const rows = linearTicks(y0, y1, height / 34);
  const left = TITLE + DIGIT * Math.max(5, ...rows.map((t) => say(t).length));
  const width = Math.max(60, size.width - left - RIGHT);
  const px = (x: number) => left + ((x - x0) / (x1 - x0)) * width;
  const py = (y: number) => TOP + height - ((y - y0) / (y1 - y0)) * height;
  const colour = (i: number) => TRACE_COLOURS[scheme][1 + (i % (TRACE_COLOURS[scheme].length - 1))];
  const dash = (i: number) => DASHES[i % DASHES.length].join(" ");

  return (
    <figure className={styles.chart}>
      <figcaption>
        {title}
        <output>{read}</output>
      </figcaption>
      <div ref={element} className={styles.stage}>
        {size.width > 80 && (
          <svg
            width={size.width}
            height={size.height}
            role="img"
            aria-label={`${title}: ${yLabel} over ${xLabel}`}
            onPointerMove={(event) =>
              setRead(nearest(lines, px, py, event.nativeEvent.offsetX, event.nativeEvent.offsetY))
            }
            onPointerLeave={() => setRead(undefined)}
          >
            {linearTicks(x0, x1, width / 70).map((t) => (
              <g key={`x${t}`}>
                <path d={`M${px(t)} ${TOP}V${TOP + height}`} className={styles.grid} />
                <text x={px(t)} y={TOP + height + 15} textAnchor="middle">
                  {say(t)}
                </text>
              </g>
            ))}
            {rows.map((t) => (
              <g key={`y${t}`}>
                <path d={`M${left} ${py(t)}H${left + width}`} className={styles.grid} />
                <text x={left - 6} y={py(t) + 4} textAnchor="end">
                  {say(t)}
                </text>
              </g>
            ))}
            <text x={left + width / 2} y={size.height - 6} textAnchor="middle" className={styles.axis}>
              {xLabel}
            </text>
            <text
              transform={`translate(12 ${TOP + height / 2}) rotate(-90)`}
              textAnchor="middle"
              className={styles.axis}
            >
              {yLabel}
            </text>
            {lines.map((line, i) => (
              <g key={line.name} stroke={colour(i)} fill="none">
                <path d={pathOf(line, px, py)} strokeWidth={2} strokeDasharray={dash(i)} strokeLinejoin="round" />
                {line.spread && (
                  <path
                    d={line.x
                      .map((x, j) => {
                        const half = line.spread?.[j] ?? 0;
                        return half > 0 ? `M${px(x)} ${py(line.y[j] - half)}V${py(line.y[j] + half)}` : "";
                      })
                      .join("")}
                  />
                )}
                {(line.spread || line.x.length === 1) &&
                  line.x.map((x, j) => <circle key={x} cx={px(x)} cy={py(line.y[j])} r={3} fill={colour(i)} />)}
              </g>
            ))}
          </svg>
        )}
      </div>
      {lines.length > 1 && (
        <ul className={styles.legend}>
          {lines.map((line, i) => (
            <li key={line.name}>
              <svg width="24" height="8" aria-hidden="true">
                <path d="M0 4H24" stroke={colour(i)} strokeWidth="2.2" strokeDasharray={dash(i)} />
              </svg>
              {line.name}
            </li>
          ))}
        </ul>
      )}
    </figure>
  );
}

const say = (value: number) => String(Number(value.toPrecision(6))).replace("-", "−");

function pathOf(line: ChartLine, px: (x: number) => number, py: (y: number) => number): string {
  return line.x
    .map((x, i) => {
      const X = px(x).toFixed(1);
      const Y = py(line.y[i]).toFixed(1);
      return i === 0 ? `M${X} ${Y}` : line.isStepped ? `H${X}V${Y}` : `L${X} ${Y}`;
    })
    .join("");
}

/** A range with some air around the values. */
function spanOf(values: readonly number[]): [number, number] {
  const finite = values.filter(Number.isFinite);
  if (finite.length === 0) return [0, 1];
  const low = finite.reduce((a, b) => Math.min(a, b));
  const high = finite.reduce((a, b) => Math.max(a, b));
  if (high - low <= 1e-9 * Math.max(Math.abs(low), Math.abs(high))) {
    const air = 0.5 * Math.abs(high) || 0.5;
    return [low - air, high + air];
  }
  return [low - 0.04 * (high - low), high + 0.04 * (high - low)];
}

const REACH_PX = 40;

/** What the point nearest to the pointer says. */
function nearest(
  lines: readonly ChartLine[],
  px: (x: number) => number,
  py: (y: number) => number,
  atX: number,
  atY: number,
): string | undefined {
  let best = REACH_PX;
  let found: string | undefined;
  for (const line of lines)
    line.x.forEach((x, i) => {
      const far = Math.hypot(px(x) - atX, py(line.y[i]) - atY);
      if (far >= best) return;
      best = far;
      const spread = line.spread?.[i] ? ` ± ${say(Number(line.spread[i].toPrecision(3)))}` : "";
      found = `${line.name ? `${line.name}: ` : ""}${say(Number(x.toPrecision(4)))}, ${say(Number(line.y[i].toPrecision(4)))}${spread}`;
    });
  return found;
}
