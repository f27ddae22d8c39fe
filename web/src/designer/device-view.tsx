import { Button } from "@mantine/core";
import { useMemo } from "react";
import { deviceDrawing } from "../picture/device-drawing";
import { DevicePlan } from "../picture/device-plan";
import { resonatorParts } from "../picture/plan-parts";
import { EmptyState } from "../ui/empty-state";
import { formatNumber, formatShort, formatSi } from "../ui/format";
import styles from "./designer.module.css";
import { COLOURS, Parts } from "./parts";

const MARGIN = 14;
const SCALE_BARS = [20, 50, 100, 200, 500];

interface DeviceViewProps {
  geometry: Record<string, number> | null;
  title: string;
  /** Take a device that has a drawing. */
  onChooseDrawn(): void;
}

/** The device from above, to scale: beams thinner than a pixel are drawn one pixel wide. */
export function DeviceView({ geometry, title, onChooseDrawn }: DeviceViewProps) {
  const drawing = useMemo(() => (geometry ? deviceDrawing(geometry) : undefined), [geometry]);
  if (!drawing || !geometry)
    return (
      <EmptyState
        title="No drawing"
        action={
          <Button size="xs" onClick={onChooseDrawn}>
            Take LCR-350
          </Button>
        }
      >
        {title} is given by its mass, damping and stiffness. A device with a drawing, such as LCR-350, is drawn here.
      </EmptyState>
    );
  const width = drawing.width + 2 * MARGIN;
  const height = drawing.height + 2 * MARGIN + 26;
  // of the drawing's own units, so that a large device has no small letters
  const letters = { fontSize: width / 13 };
  const bar = SCALE_BARS.filter((um) => um < width / 3).at(-1) ?? SCALE_BARS[0];
  return (
    <>
      <svg
        className={styles.device}
        viewBox={`${-width / 2} ${-drawing.height / 2 - MARGIN} ${width} ${height}`}
        role="img"
        aria-label={`${title} from above, to scale: ${formatSi(drawing.width, "um")} by ${formatSi(drawing.height, "um")}`}
      >
        <DevicePlan parts={resonatorParts(drawing)} />
        <g transform={`translate(${-width / 2 + MARGIN} ${drawing.height / 2 + 22})`}>
          <path d={`M0 -5 V5 M0 0 H${bar} M${bar} -5 V5`} className={styles.scale} />
          <text x={bar + 8} dominantBaseline="middle" className={styles.scaleText} style={letters}>
            {formatShort(bar, "um")}
          </text>
        </g>
        <g transform={`translate(${width / 2 - MARGIN} ${drawing.height / 2 + 22})`}>
          <path d="M-70 0 H-4 M-14 -7 L-4 0 L-14 7" className={styles.scale} />
          <text x={-80} textAnchor="end" dominantBaseline="middle" className={styles.scaleText} style={letters}>
            x
          </text>
        </g>
      </svg>
      <Parts
        parts={[
          ["shuttle, moves", COLOURS.shuttle],
          ["beams and trusses, bend", COLOURS.beam],
          ["stators", COLOURS.stator],
          ["anchors"],
        ]}
      />
      <CombDetail geometry={geometry} />
    </>
  );
}

/** Two fingers between three, enlarged: the gap and the overlap that make the force. */
function CombDetail({ geometry: g }: { geometry: Record<string, number> }) {
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
