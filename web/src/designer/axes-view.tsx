import { Box } from "@mantine/core";
import { formatIn, formatSi } from "../ui/format";
import styles from "./designer.module.css";
import { COLOURS, Parts } from "./parts";

interface AxesViewProps {
  metrics: Record<string, number>;
  title: string;
}

const ARM = 150;
const BOX = 44;
const PLATE = `color-mix(in srgb, ${COLOURS.shuttle} 40%, var(--panel))`;
const FRAME = { near: 62, far: 76, half: 62 };

/** The axes of a gyroscope: of its layout, of its stiffness, and the line along which the mass swings. */
export function AxesView({ metrics, title }: AxesViewProps) {
  const axis = metrics["gyro.axis_deg"];
  const tilt = metrics["gyro.tilt_deg"];
  const isDrawn = "gyro.mass_x_kg" in metrics;
  return (
    <>
      <svg
        className={styles.device}
        viewBox="-180 -180 360 360"
        role="img"
        aria-label={`${title}: axis of stiffness at ${formatIn(axis, "°", 3)}, locus at ${formatIn(tilt, "°", 3)}`}
      >
        <path d={`M${-ARM} 0H${ARM}M0 ${ARM}V${-ARM}`} className={styles.scale} strokeDasharray="2 4" />
        <text x={ARM + 6} y={6} className={styles.scaleText}>
          x
        </text>
        <text x={-6} y={-ARM - 8} className={styles.scaleText}>
          y
        </text>
        {isDrawn && <Frames />}
        <g transform={`rotate(${-axis})`}>
          <path d={`M${-ARM} 0H${ARM}M0 ${ARM}V${-ARM}`} stroke={COLOURS.beam} strokeWidth={2} />
          <rect x={-BOX} y={-BOX} width={2 * BOX} height={2 * BOX} fill={PLATE} stroke={COLOURS.stator} />
        </g>
        <g transform={`rotate(${-tilt})`}>
          <path d={`M${-ARM} 0H${ARM}`} stroke={COLOURS.shuttle} strokeWidth={3} />
          <circle cx={ARM} r={5} fill={COLOURS.shuttle} />
        </g>
      </svg>
      <Parts
        parts={[
          [`axes of stiffness, ${formatIn(axis, "°", 3)} against x`, COLOURS.beam],
          [`swing with y free, ${formatIn(tilt, "°", 3)}`, COLOURS.shuttle],
          ...(isDrawn ? frames(metrics) : []),
        ]}
      />
      <Box component="p" className="note" mt={8}>
        {isDrawn &&
          "The frames are not to scale: a folded flexure yields along one axis alone, so each axis has its frame, and the plate, which the rate acts on, moves along both. "}
        Angles are as large as they are. A gyroscope reads stiffness and damping along other axes than x and y as a
        false rate.
      </Box>
    </>
  );
}

const frames = (metrics: Record<string, number>): [string, string][] => [
  [`drive frame, moves along x: ${formatSi(metrics["gyro.mass_x_kg"], "kg", 3)} with the plate`, COLOURS.driveFrame],
  [`sense frame, moves along y: ${formatSi(metrics["gyro.mass_y_kg"], "kg", 3)} with the plate`, COLOURS.senseFrame],
];

/** The drive frame beside the plate and the sense frame above and below it. */
function Frames() {
  const { near, far, half } = FRAME;
  return (
    <>
      <path
        fill={COLOURS.driveFrame}
        d={`M${near} ${-half}H${far}V${half}H${near}ZM${-near} ${-half}H${-far}V${half}H${-near}Z`}
      />
      <path
        fill={COLOURS.senseFrame}
        d={`M${-half} ${near}V${far}H${half}V${near}ZM${-half} ${-near}V${-far}H${half}V${-near}Z`}
      />
    </>
  );
}
