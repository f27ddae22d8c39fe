import type { PositiveReal } from "../api/types";
import { formatShort, tickLabels } from "../ui/format";
import { linearTicks } from "../ui/ticks";
import { roundTo } from "../ui/unit-scale";
import { useSize } from "../ui/use-size";
import styles from "./theory.module.css";

export const HEIGHT = 270;
const LEFT = 46;
const BOTTOM = 34;

/** Re G(jw) over frequency, and the curve of Nyquist beside it; what lies below zero is marked. */
export function RealPart({ found }: { found: PositiveReal }) {
  const { element, size } = useSize<HTMLDivElement>();
  const label = `Real part over frequency; least ${found.least_real === null ? "unbounded" : formatShort(found.least_real, "")}`;
  const split = size.width > 460;
  const width = split ? size.width * 0.58 : size.width;
  const second = split ? size.width - width : size.width;
  return (
    <div ref={element} className={styles.plots}>
      {size.width > 120 && (
        <>
          <OverFrequency found={found} label={label} width={width} />
          <Nyquist found={found} width={second} />
        </>
      )}
    </div>
  );
}

interface PartProps {
  found: PositiveReal;
  width: number;
}

export function OverFrequency({ found, label = "Real part over frequency", width }: PartProps & { label?: string }) {
  return (
    <Plot
      label={label}
      width={width}
      x={found.frequency.map(Math.log10)}
      y={found.real}
      across="ω, rad per unit of time"
      up="Re G(jω)"
      log
    />
  );
}

export function Nyquist({ found, width }: PartProps) {
  return (
    <Plot
      label="Nyquist curve: imaginary over real part"
      width={width}
      x={found.real}
      y={found.imaginary}
      across="Re G(jω)"
      up="Im G(jω)"
    />
  );
}

interface PlotProps {
  label: string;
  width: number;
  x: (number | null)[];
  y: (number | null)[];
  across: string;
  up: string;
  log?: boolean;
}

function Plot({ label, width, x, y, across, up, log = false }: PlotProps) {
  const points = x.flatMap((value, i) => {
    const other = y[i];
    return value === null || other === null ? [] : [[value, other] as const];
  });
  const [left, right] = log ? ends(points.map((p) => p[0])) : around(points.map((p) => p[0]));
  const [low, high] = around(points.map((p) => p[1]));
  const wide = Math.max(40, width - LEFT - 10);
  const tall = HEIGHT - BOTTOM - 8;
  const px = (value: number) => LEFT + ((value - left) / (right - left)) * wide;
  const py = (value: number) => 8 + tall - ((value - low) / (high - low)) * tall;
  const path = points.map(([a, b], i) => `${i ? "L" : "M"}${roundTo(px(a), 5)} ${roundTo(py(b), 5)}`).join("");
  const forbidden = log
    ? low < 0 && { x: LEFT, y: py(0), width: wide, height: Math.max(0, 8 + tall - py(0)) }
    : left < 0 && { x: LEFT, y: 8, width: Math.max(0, px(0) - LEFT), height: tall };
  const rows = linearTicks(low, high, 4);
  const columns = linearTicks(left, right, log ? right - left : wide / 80).filter(
    (tick) => !log || Number.isInteger(tick),
  );
  const rowLabels = tickLabels(rows);
  const columnLabels = log ? columns.map((tick) => formatShort(10 ** tick, "")) : tickLabels(columns);
  return (
    <svg width={width} height={HEIGHT} role="img" aria-label={label}>
      {forbidden && <rect {...forbidden} className={styles.forbidden} />}
      {rows.map((tick, i) => (
        <g key={tick}>
          <path d={`M${LEFT} ${py(tick)} H${LEFT + wide}`} className={tick === 0 ? styles.zero : styles.grid} />
          <text x={LEFT - 6} y={py(tick) + 4} textAnchor="end" className={styles.tick}>
            {rowLabels[i]}
          </text>
        </g>
      ))}
      {columns.map((tick, i) => (
        <g key={tick}>
          <path d={`M${px(tick)} 8 V${8 + tall}`} className={!log && tick === 0 ? styles.zero : styles.grid} />
          <text x={px(tick)} y={HEIGHT - 20} textAnchor="middle" className={styles.tick}>
            {columnLabels[i]}
          </text>
        </g>
      ))}
      <path d={path} className={styles.curve} />
      <text x={LEFT + wide} y={HEIGHT - 5} textAnchor="end" className={styles.tick}>
        {across}
      </text>
      <text x={(log ? LEFT : Math.max(LEFT, px(0))) + 6} y={19} className={styles.tick}>
        {up}
      </text>
    </svg>
  );
}

const ends = (values: number[]): [number, number] => [Math.min(...values), Math.max(...values)];

/** The middle of the values with zero and some air: a pole on the axis must not flatten everything else. */
function around(values: number[]): [number, number] {
  const sorted = [...values].sort((a, b) => a - b);
  const at = (share: number) => sorted[Math.round(share * (sorted.length - 1))] ?? 0;
  const spread = Math.max(at(0.95) - at(0.05), 1e-9);
  const low = Math.min(0, Math.max(sorted[0] ?? 0, at(0.05) - 2 * spread));
  const high = Math.max(0, Math.min(sorted.at(-1) ?? 0, at(0.95) + 2 * spread));
  const air = 0.06 * Math.max(high - low, 1e-9);
  return [low - air, high + air];
}
