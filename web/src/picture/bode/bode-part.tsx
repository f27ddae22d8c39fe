import { formatShort } from "../../ui/format";
import { roundTo } from "../../ui/unit-scale";
import styles from "./bode.module.css";

interface BodePartProps {
  left: number;
  top: number;
  width: number;
  height: number;
  x(hertz: number): number;
  range: [number, number];
  ticks: number[];
  unit: string;
  frequencies: number[];
  /** Whether frequencies are written under this part. */
  labelled?: boolean;
  lines: { name: string; colour: string; dash?: string; hertz: number[]; values: number[] }[];
  band?: { hertz: number[]; low: number[]; high: number[] };
  points?: { colour: string; hertz: number[]; values: number[]; errors: number[] | undefined };
  at: number | undefined;
  /** Whether the title stands upright beside the field. */
  isFramed?: boolean;
}

const LABEL_PX = 46;

/** One of the two fields of a Bode diagram. */
export function BodePart(props: BodePartProps) {
  const { left, top, width, height, x, range, ticks, unit, frequencies, labelled, lines, band, points, at, isFramed } =
    props;
  const y = (value: number) => {
    const clipped = Math.min(Math.max(value, range[0]), range[1]);
    return height - ((clipped - range[0]) / (range[1] - range[0])) * height;
  };
  const path = (hertz: number[], values: number[]) =>
    hertz.map((f, i) => `${i ? "L" : "M"}${roundTo(x(f), 5)} ${roundTo(y(values[i]), 5)}`).join("");
  return (
    <g transform={`translate(${left} ${top})`}>
      {frequencies.map((f) => (
        <path key={f} d={`M${x(f)} 0 V${height}`} className={styles.grid} />
      ))}
      {ticks.map((tick) => (
        <g key={tick}>
          <path d={`M0 ${y(tick)} H${width}`} className={styles.grid} />
          <text x={-6} y={y(tick) + 4} textAnchor="end" className={styles.tick}>
            {formatShort(tick, "")}
          </text>
        </g>
      ))}
      <text
        {...(isFramed
          ? { transform: `translate(-50 ${height / 2}) rotate(-90)`, textAnchor: "middle" }
          : { x: 6, y: 14 })}
        className={styles.unit}
      >
        {unit === "dB" ? "magnitude re static, dB" : "phase, °"}
      </text>
      {band && (
        <path
          d={`${path(band.hertz, band.high)}${path([...band.hertz].reverse(), [...band.low].reverse()).replace("M", "L")}Z`}
          className={styles.band}
        />
      )}
      {lines.map((line) => (
        <path
          key={line.name}
          d={path(line.hertz, line.values)}
          fill="none"
          stroke={line.colour}
          strokeWidth={2}
          strokeDasharray={line.dash}
          strokeLinejoin="round"
        />
      ))}
      {points?.hertz.map((f, i) => (
        <g key={f}>
          {points.errors && (
            <path
              d={`M${x(f)} ${y(points.values[i] - points.errors[i])} V${y(points.values[i] + points.errors[i])}`}
              stroke={points.colour}
            />
          )}
          <circle cx={x(f)} cy={y(points.values[i])} r={2.6} fill={points.colour} />
        </g>
      ))}
      {at !== undefined && <path d={`M${x(at)} 0 V${height}`} className={styles.cursor} />}
      {labelled &&
        spaced(frequencies, x).map((f) => (
          <text key={f} x={x(f)} y={height + 16} textAnchor="middle" className={styles.tick}>
            {formatShort(f, "Hz")}
          </text>
        ))}
    </g>
  );
}

/** As many labels as have room. */
function spaced(frequencies: number[], x: (f: number) => number): number[] {
  let last = -LABEL_PX;
  return frequencies.filter((f) => {
    if (x(f) - last < LABEL_PX) return false;
    last = x(f);
    return true;
  });
}
