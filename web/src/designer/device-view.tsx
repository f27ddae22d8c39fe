import { Button } from "@mantine/core";
import { useMemo } from "react";
import { deviceDrawing } from "../picture/device-drawing";
import { DevicePlan } from "../picture/device-plan";
import { EmptyState } from "../ui/empty-state";
import { formatShort, formatSi } from "../ui/format";
import { CombDetail } from "./comb-detail";
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
        <DevicePlan drawing={drawing} />
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
