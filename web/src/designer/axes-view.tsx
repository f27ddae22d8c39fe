import { formatIn, formatSi } from "../ui/format";
import styles from "./designer.module.css";

interface AxesViewProps {
  metrics: Record<string, number>;
  title: string;
}

const ARM = 150;
const BOX = 44;
const FRAME = { near: 62, far: 76, half: 62 };

/** The axes of a gyroscope: those of the layout, that of its stiffness, and the line along which the mass swings. */
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
        <g transform={`rotate(${-axis})`} className={styles.principal}>
          <path d={`M${-ARM} 0H${ARM}M0 ${ARM}V${-ARM}`} />
          <rect x={-BOX} y={-BOX} width={2 * BOX} height={2 * BOX} />
        </g>
        <g transform={`rotate(${-tilt})`} className={styles.swing}>
          <path d={`M${-ARM} 0H${ARM}`} />
          <circle cx={ARM} r={5} />
        </g>
      </svg>
      <ul className={styles.parts}>
        <li data-part="beam">axes of stiffness, {formatIn(axis, "°", 3)} against x</li>
        <li data-part="shuttle">swing with y free, {formatIn(tilt, "°", 3)}</li>
        {isDrawn && (
          <>
            <li data-part="drive-frame">
              drive frame, moves along x: {formatSi(metrics["gyro.mass_x_kg"], "kg", 3)} with the plate
            </li>
            <li data-part="sense-frame">
              sense frame, moves along y: {formatSi(metrics["gyro.mass_y_kg"], "kg", 3)} with the plate
            </li>
          </>
        )}
      </ul>
      <p className={styles.source}>
        {isDrawn &&
          "The frames are not to scale: a folded flexure yields along one axis alone, so each axis has its frame, and the plate, which the rate acts on, moves along both. "}
        Angles are as large as they are. A gyroscope reads stiffness and damping along other axes than x and y as a
        false rate.
      </p>
    </>
  );
}

/** The drive frame beside the plate and the sense frame above and below it. */
function Frames() {
  const { near, far, half } = FRAME;
  return (
    <>
      <path
        fill="#cc79a7"
        d={`M${near} ${-half}H${far}V${half}H${near}ZM${-near} ${-half}H${-far}V${half}H${-near}Z`}
      />
      <path
        fill="#009e73"
        d={`M${-half} ${near}V${far}H${half}V${near}ZM${-half} ${-near}V${-far}H${half}V${-near}Z`}
      />
    </>
  );
}
