import { formatSi } from "../../ui/format";
import type { Scheme } from "../../ui/palette";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import type { AliasPartProps } from "./alias-sweep";
import styles from "./hypotheses.module.css";
import { PlaneAxes } from "./plane-axes";

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

const spread = (values: number[]) => Math.max(...values) - Math.min(...values);
const middle = (values: number[]) => (Math.max(...values) + Math.min(...values)) / 2;
