import { formatSi } from "../../ui/format";
import { linearTicks } from "../../ui/ticks";
import styles from "./hypotheses.module.css";

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
export function PlaneAxes({ px, py, cx, cy, scale, width, height }: PlaneAxesProps) {
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
