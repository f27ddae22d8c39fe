import type { AliasReport } from "../../api/types";
import { formatSi } from "../../ui/format";
import type { Scheme } from "../../ui/palette";
import { decadeTicks, linearTicks } from "../../ui/ticks";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import styles from "./hypotheses.module.css";

const FEET = 30;

interface AliasPartProps {
  report: AliasReport;
  width: number;
  height: number;
  /** With axes that need more room than the panel has. */
  isFramed?: boolean;
}

interface PhasorProps extends AliasPartProps {
  scheme: Scheme;
}

/** The motion of every hypothesis at the drive frequency, as a point. */
export function Phasors({ report, width, height, scheme, isFramed }: PhasorProps) {
  const { responses, pairs } = report.map;
  const points = responses.map(({ name, amplitudes_um: [a], phases_deg: [deg] }) => {
    const angle = (deg * Math.PI) / 180;
    return { name, x: a * Math.cos(angle), y: a * Math.sin(angle) };
  });
  const reach = spread(points.map((p) => p.x)) / width > spread(points.map((p) => p.y)) / height;
  const noise = report.sensor_noise_um;
  const scale = reach
    ? (0.62 * width) / Math.max(spread(points.map((p) => p.x)), 4 * noise, 1e-9)
    : (0.62 * height) / Math.max(spread(points.map((p) => p.y)), 4 * noise, 1e-9);
  const cx = middle(points.map((p) => p.x));
  const cy = middle(points.map((p) => p.y));
  const px = (x: number) => width / 2 + (x - cx) * scale;
  const py = (y: number) => height / 2 - 8 - (y - cy) * scale;
  const at = (name: string) => points.find((p) => p.name === name);
  const close = pairs.filter((p) => p.coincident);
  return (
    <svg
      width={width}
      height={height}
      role="img"
      aria-label="Motion of every hypothesis at the drive frequency, in the complex plane"
    >
      <text x={4} y={14} className={styles.tick}>
        motion at the drive, in the complex plane
      </text>
      {isFramed && <PlaneAxes px={px} py={py} cx={cx} cy={cy} scale={scale} width={width} height={height} />}
      {close.map(({ first, second }) => {
        const a = at(first);
        const b = at(second);
        return (
          a &&
          b && (
            <path
              key={`${first} ${second}`}
              d={`M${px(a.x)} ${py(a.y)} L${px(b.x)} ${py(b.y)}`}
              className={styles.alias}
            />
          )
        );
      })}
      {points.map(({ name, x, y }, i) => (
        <g key={name}>
          <circle cx={px(x)} cy={py(y)} r={Math.min(80, noise * scale)} className={styles.noise} />
          <circle cx={px(x)} cy={py(y)} r={5} fill={traceColour(hypothesisStyle(i), scheme)} />
          <text x={px(x) + 8} y={py(y) - 6 + (i % 2) * 18} className={styles.point}>
            {name}
          </text>
        </g>
      ))}
      <text x={isFramed ? 60 : 4} y={height - (isFramed ? 48 : 8)} className={styles.tick}>
        rings: noise of one sample, {formatSi(noise, "um", 3)}
      </text>
    </svg>
  );
}

/** Distance of the closest pair over the drive frequency. */
export function Sweep({ report, width, height, isFramed }: AliasPartProps) {
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
        d={hertz.map((f, i) => `${i ? "L" : "M"}${x(f).toFixed(1)} ${y(logs[i]).toFixed(1)}`).join("")}
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

interface PlaneAxesProps {
  px(x: number): number;
  py(y: number): number;
  /** What lies in the middle, and pixels for each micrometre. */
  cx: number;
  cy: number;
  scale: number;
  width: number;
  height: number;
}

/** Numbers along a complex plane of motions. */
function PlaneAxes({ px, py, cx, cy, scale, width, height }: PlaneAxesProps) {
  const left = 56;
  const bottom = height - 40;
  const half = { x: (0.5 * width) / scale, y: (0.5 * height) / scale };
  const columns = linearTicks(cx - half.x, cx + half.x, 4).filter((t) => px(t) > left + 20 && px(t) < width - 30);
  const rows = linearTicks(cy - half.y, cy + half.y, 5).filter((t) => py(t) > 30 && py(t) < bottom - 10);
  return (
    <g>
      <path d={`M${left} 22V${bottom}H${width - 8}`} fill="none" className={styles.grid} />
      {columns.map((t) => (
        <g key={`x${t}`}>
          <path d={`M${px(t)} 22V${bottom}`} className={styles.grid} />
          <text x={px(t)} y={bottom + 15} textAnchor="middle" className={styles.tick}>
            {formatSi(t, "um", 3)}
          </text>
        </g>
      ))}
      {rows.map((t) => (
        <g key={`y${t}`}>
          <path d={`M${left} ${py(t)}H${width - 8}`} className={styles.grid} />
          <text x={left - 5} y={py(t) + 4} textAnchor="end" className={styles.tick}>
            {formatSi(t, "um", 3)}
          </text>
        </g>
      ))}
      <text x={(left + width) / 2} y={height - 6} textAnchor="middle" className={styles.tick}>
        real part of the motion
      </text>
      <text x={left + 6} y={36} className={styles.tick}>
        imaginary part
      </text>
    </g>
  );
}

const spread = (values: number[]) => Math.max(...values) - Math.min(...values);
const middle = (values: number[]) => (Math.max(...values) + Math.min(...values)) / 2;
