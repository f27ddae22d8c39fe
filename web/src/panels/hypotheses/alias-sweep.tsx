import type { AliasReport } from "../../api/types";
import { formatSi } from "../../ui/format";
import { decadeTicks } from "../../ui/ticks";
import { roundTo } from "../../ui/unit-scale";
import styles from "./hypotheses.module.css";

const FEET = 30;

export interface AliasPartProps {
  report: AliasReport;
  width: number;
  height: number;
  /** With axes that need more room than the panel has. */
  isFramed?: boolean;
}

/** Distance of the closest pair over the drive frequency. */
export function AliasSweep({ report, width, height, isFramed }: AliasPartProps) {
  const { frequency_hz: hertz, distance_um: distance } = report.sweep;
  const tone = report.map.tones_hz[0];
  const wide = width - 56;
  const tall = height - FEET - 20;
  const logs = distance.map((d) => Math.log10(Math.max(d, 1e-7)));
  const high = Math.ceil(Math.max(...logs, Math.log10(Math.max(report.sensor_noise_um, 1e-7))));
  const low = Math.max(high - 5, Math.floor(Math.min(...logs)));
  const x = (f: number) => 46 + (Math.log(f / hertz[0]) / Math.log(hertz[hertz.length - 1] / hertz[0])) * wide;
  const y = (log: number) => 20 + tall - ((Math.max(log, low) - low) / (high - low)) * tall;
  let last = Number.NEGATIVE_INFINITY;
  return (
    <svg width={width} height={height} role="img" aria-label="Distance of the closest pair over the drive frequency">
      <text x={46} y={14} className={styles.tick}>
        {isFramed
          ? "distance of the closest pair, µm, over the drive frequency, Hz"
          : "closest pair over the drive frequency"}
      </text>
      {Array.from({ length: high - low + 1 }, (_, i) => low + i).map((power) => (
        <g key={power}>
          <path d={`M46 ${y(power)} H${46 + wide}`} className={styles.grid} />
          <text x={40} y={y(power) + 4} textAnchor="end" className={styles.tick}>
            {formatSi(10 ** power, "um", 1)}
          </text>
        </g>
      ))}
      {decadeTicks(hertz[0], hertz[hertz.length - 1]).map((f) => {
        if (x(f) - last < 54 || x(f) > width - 30) return null;
        last = x(f);
        return (
          <text key={f} x={x(f)} y={height - 12} textAnchor="middle" className={styles.tick}>
            {formatSi(f, "Hz", 1)}
          </text>
        );
      })}
      <path
        d={`M46 ${y(Math.log10(Math.max(report.sensor_noise_um, 1e-7)))} H${46 + wide}`}
        className={styles.noiseLine}
      />
      <path d={`M${x(report.f0_hz)} 20 V${20 + tall}`} className={styles.grid} />
      <text x={x(report.f0_hz) + 3} y={20 + tall - 4} className={styles.tick}>
        f₀
      </text>
      <path
        d={hertz.map((f, i) => `${i ? "L" : "M"}${roundTo(x(f), 5)} ${roundTo(y(logs[i]), 5)}`).join("")}
        className={styles.curve}
      />
      {tone > hertz[0] && (
        <>
          <path d={`M${x(tone)} 20 V${20 + tall}`} className={styles.now} />
          <text x={x(tone) - 5} y={34} textAnchor="end" className={styles.tick}>
            drive
          </text>
        </>
      )}
    </svg>
  );
}
