import { useMemo } from "react";
import { decadeTicks, linearTicks } from "../../ui/ticks";
import { type BodeBand, type BodeCurve, type BodePoints, dbRange, nearest } from "./bode-data";
import { BodePart } from "./bode-part";

export interface BodeFieldProps {
  label: string;
  curves: BodeCurve[];
  band?: BodeBand;
  points?: BodePoints;
  /** What the phase may span. */
  degrees?: [number, number];
  width: number;
  height: number;
  /** With upright titles beside the fields, which have no room in a panel. */
  isFramed?: boolean;
  /** Index of the frequency that is read. */
  read?: number;
  onRead?(index: number | undefined): void;
}

const LEFT = 48;
const TITLED_LEFT = 68;
const RIGHT = 14;
const AXIS = 30;
const BETWEEN = 22;

/** Magnitude over phase, on one logarithmic axis of frequency. */
export function BodeField(props: BodeFieldProps) {
  const { label, curves, band, points, degrees = [-180, 0], isFramed, read, onRead, ...size } = props;
  const left = isFramed ? TITLED_LEFT : LEFT;
  const hertz = curves[0].hertz;
  const low = hertz[0];
  const high = hertz[hertz.length - 1];
  const range = useMemo(
    () => dbRange([...curves.flatMap((c) => c.db), ...(band?.db.high ?? []), ...(points?.db ?? [])]),
    [curves, band, points],
  );
  const width = Math.max(60, size.width - left - RIGHT);
  const upper = Math.max(40, (size.height - AXIS - BETWEEN) * 0.62);
  const lower = Math.max(30, size.height - AXIS - BETWEEN - upper);
  const x = (f: number) => (Math.log(f / low) / Math.log(high / low)) * width;
  return (
    <svg
      width={size.width}
      height={size.height}
      role="img"
      aria-label={label}
      onPointerMove={(event) => {
        const share = (event.nativeEvent.offsetX - left) / width;
        onRead?.(share < 0 || share > 1 ? undefined : nearest(hertz, low * (high / low) ** share));
      }}
      onPointerLeave={() => onRead?.(undefined)}
    >
      <BodePart
        left={left}
        isFramed={isFramed}
        top={6}
        width={width}
        height={upper}
        x={x}
        range={range}
        ticks={linearTicks(range[0], range[1], upper / 34)}
        unit="dB"
        frequencies={decadeTicks(low, high)}
        lines={curves.map((c) => ({ ...c, values: c.db }))}
        band={band && { hertz: band.hertz, ...band.db }}
        points={points && { ...points, values: points.db, errors: points.errorDb }}
        at={read === undefined ? undefined : hertz[read]}
      />
      <BodePart
        left={left}
        isFramed={isFramed}
        top={upper + BETWEEN}
        width={width}
        height={lower}
        x={x}
        range={degrees}
        ticks={[-180, -135, -90, -45, 0, 45, 90].filter(
          (d) => d >= degrees[0] && d <= degrees[1] && (lower > 110 || d % 90 === 0),
        )}
        unit="°"
        frequencies={decadeTicks(low, high)}
        labelled
        lines={curves.map((c) => ({ ...c, values: c.deg }))}
        band={band && { hertz: band.hertz, ...band.deg }}
        points={points && { ...points, values: points.deg, errors: undefined }}
        at={read === undefined ? undefined : hertz[read]}
      />
    </svg>
  );
}
