import { formatNumber, formatSi } from "../ui/format";
import styles from "./designer.module.css";
import { COLOURS } from "./parts";

/** Two fingers between three, enlarged: the gap and the overlap that make the force. */
export function CombDetail({ geometry: g }: { geometry: Record<string, number> }) {
  const finger = g.finger_width_um - 2 * g.comb_bias_um;
  const gap = g.finger_gap_um + 2 * g.comb_bias_um;
  const pitch = 2 * (finger + gap);
  const length = g.finger_length_um;
  const whole = 2 * length - g.overlap_um;
  const tall = 2 * pitch + finger;
  // across as along, until thin fingers in long combs would vanish
  const stretch = Math.max(1, (0.34 * whole) / tall);
  const y = (value: number) => value * stretch;
  const bars = (count: number, start: number, x: number) =>
    Array.from({ length: count }, (_, i) => `M${x} ${y(start + i * pitch)}h${length}v${y(finger)}h${-length}z`).join(
      "",
    );
  const text = whole / 24;
  return (
    <figure style={{ flex: "none" }}>
      <svg
        width="100%"
        viewBox={`-1 ${-text * 1.6} ${whole + 2} ${y(tall) + text * 3.4}`}
        role="img"
        aria-label={`Comb: gap ${formatSi(gap, "um", 3)}, overlap ${formatSi(g.overlap_um, "um", 3)}`}
      >
        <path d={bars(3, 0, whole - length)} fill={COLOURS.stator} />
        <path d={bars(2, pitch / 2, 0)} fill={COLOURS.shuttle} />
        <path
          d={`M${whole - length} ${y(tall) + text * 0.5} H${length} M${whole - length} ${y(tall)} v${text} M${length} ${y(tall)} v${text}`}
          className={styles.scale}
        />
        <text x={whole / 2} y={y(tall) + text * 1.6} fontSize={text} textAnchor="middle" fill="var(--text)">
          overlap {formatSi(g.overlap_um, "um", 3)}
        </text>
      </svg>
      <figcaption className="remark">
        Comb as etched: gap {formatSi(gap, "um", 3)}, fingers {formatSi(finger, "um", 3)} wide
        {stretch > 1 ? `; drawn ${formatNumber(stretch, 1)} times as large across as along` : ""}
      </figcaption>
    </figure>
  );
}
