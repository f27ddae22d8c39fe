import { formatShort, tickLabels } from "../ui/format";
import { DASHES, type Scheme, TRACE_COLOURS } from "../ui/palette";
import { linearTicks } from "../ui/ticks";
import { roundTo } from "../ui/unit-scale";
import styles from "./line-chart.module.css";

export interface ChartLine {
  name: string;
  x: readonly number[];
  y: readonly number[];
  /** Half the length of the bar at each point. */
  spread?: readonly number[];
  isStepped?: boolean;
}

export interface LineFieldProps {
  label: string;
  xLabel: string;
  yLabel: string;
  lines: readonly ChartLine[];
  xRange?: [number, number];
  yRange?: [number, number];
  width: number;
  height: number;
  scheme: Scheme;
  /** What the point nearest to the pointer says. */
  onRead?(said: string | undefined): void;
}

/** Room for the title of the upright axis, and for each digit of its numbers, px. */
const TITLE = 24;
const DIGIT = 8;
/** Width of a letter of that title, px. */
const LETTER = 6.2;
const RIGHT = 12;
const TOP = 8;
const BOTTOM = 40;

export const lineColour = (i: number, scheme: Scheme) =>
  TRACE_COLOURS[scheme][1 + (i % (TRACE_COLOURS[scheme].length - 1))];
export const lineDashes = (i: number) => DASHES[i % DASHES.length];

/** Lines over two titled axes. */
export function LineField(props: LineFieldProps) {
  const { label, xLabel, yLabel, lines, xRange, yRange, width, height, scheme, onRead } = props;
  const [x0, x1] = xRange ?? spanOf(lines.flatMap((l) => l.x));
  const [y0, y1] =
    yRange ?? spanOf(lines.flatMap((l) => l.y.flatMap((v, i) => [v - (l.spread?.[i] ?? 0), v + (l.spread?.[i] ?? 0)])));
  const tall = Math.max(40, height - TOP - BOTTOM);
  const rows = linearTicks(y0, y1, tall / 34);
  const rowLabels = tickLabels(rows);
  const left = TITLE + DIGIT * Math.max(5, ...rowLabels.map((text) => text.length));
  const wide = Math.max(60, width - left - RIGHT);
  const columns = linearTicks(x0, x1, wide / 70);
  const columnLabels = tickLabels(columns);
  const px = (x: number) => left + ((x - x0) / (x1 - x0)) * wide;
  const py = (y: number) => TOP + tall - ((y - y0) / (y1 - y0)) * tall;
  const colour = (i: number) => lineColour(i, scheme);
  return (
    <svg
      width={width}
      height={height}
      role="img"
      aria-label={label}
      className={styles.field}
      onPointerMove={({ nativeEvent: { offsetX, offsetY } }) => onRead?.(nearest(lines, px, py, offsetX, offsetY))}
      onPointerLeave={() => onRead?.(undefined)}
    >
      {columns.map((t, i) => (
        <g key={`x${t}`}>
          <path d={`M${px(t)} ${TOP}V${TOP + tall}`} className={styles.grid} />
          <text x={px(t)} y={TOP + tall + 15} textAnchor="middle">
            {columnLabels[i]}
          </text>
        </g>
      ))}
      {rows.map((t, i) => (
        <g key={`y${t}`}>
          <path d={`M${left} ${py(t)}H${left + wide}`} className={styles.grid} />
          <text x={left - 6} y={py(t) + 4} textAnchor="end">
            {rowLabels[i]}
          </text>
        </g>
      ))}
      <text x={left + wide / 2} y={height - 6} textAnchor="middle" className={styles.axis}>
        {xLabel}
      </text>
      <text
        transform={`translate(12 ${height / 2}) rotate(-90)`}
        textAnchor="middle"
        className={styles.axis}
        {...(LETTER * yLabel.length > height && { textLength: height - 8, lengthAdjust: "spacingAndGlyphs" })}
      >
        {yLabel}
      </text>
      {lines.map((line, i) => (
        <g key={line.name} stroke={colour(i)} fill="none">
          <path
            d={pathOf(line, px, py)}
            strokeWidth={2}
            strokeDasharray={lineDashes(i).join(" ")}
            strokeLinejoin="round"
          />
          {line.x.map((x, j) => {
            const half = line.spread?.[j] ?? 0;
            return half > 0 && <path key={x} d={`M${px(x)} ${py(line.y[j] - half)}V${py(line.y[j] + half)}`} />;
          })}
          {(line.spread || line.x.length === 1) &&
            line.x.map((x, j) => <circle key={x} cx={px(x)} cy={py(line.y[j])} r={3} fill={colour(i)} />)}
        </g>
      ))}
    </svg>
  );
}

function pathOf(line: ChartLine, px: (x: number) => number, py: (y: number) => number): string {
  return line.x
    .map((x, i) => {
      const X = roundTo(px(x), 5);
      const Y = roundTo(py(line.y[i]), 5);
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
      const spread = line.spread?.[i] ? ` ± ${formatShort(line.spread[i], "", 3)}` : "";
      found = `${line.name ? `${line.name}: ` : ""}${formatShort(x, "")}, ${formatShort(line.y[i], "")}${spread}`;
    });
  return found;
}
