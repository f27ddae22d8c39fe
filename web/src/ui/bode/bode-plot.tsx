import { useMemo, useState } from "react";
import { formatSi } from "../format";
import { decadeTicks, linearTicks } from "../ticks";
import { useSize } from "../use-size";
import styles from "./bode.module.css";
import { type BodeBand, type BodeCurve, type BodePoints, dbRange, nearest } from "./bode-data";
import { BodePart } from "./bode-part";

interface BodePlotProps {
  label: string;
  curves: BodeCurve[];
  band?: BodeBand;
  points?: BodePoints;
  /** What the phase may span. */
  degrees?: [number, number];
}

const LEFT = 48;
const RIGHT = 14;
const AXIS = 30;
const BETWEEN = 22;

/** Magnitude over phase, on one logarithmic axis of frequency; the pointer reads both. */
export function BodePlot({ label, curves, band, points, degrees = [-180, 0] }: BodePlotProps) {
  const { element, size } = useSize<HTMLDivElement>();
  const [at, setAt] = useState<number | undefined>(undefined);
  const hertz = curves[0].hertz;
  const low = hertz[0];
  const high = hertz[hertz.length - 1];
  const range = useMemo(
    () => dbRange([...curves.flatMap((c) => c.db), ...(band?.db.high ?? []), ...(points?.db ?? [])]),
    [curves, band, points],
  );
  const width = Math.max(60, size.width - LEFT - RIGHT);
  const upper = Math.max(40, (size.height - AXIS - BETWEEN) * 0.62);
  const lower = Math.max(30, size.height - AXIS - BETWEEN - upper);
  const x = (f: number) => (Math.log(f / low) / Math.log(high / low)) * width;
  const read = at === undefined ? undefined : nearest(hertz, at);

  return (
    <div className={styles.plot}>
      <ul className={styles.legend}>
        {curves.map((curve) => (
          <li key={curve.name}>
            <svg width="22" height="8" aria-hidden="true">
              <path d="M0 4 H22" stroke={curve.colour} strokeWidth="2.2" strokeDasharray={curve.dash} />
            </svg>
            {curve.name}
          </li>
        ))}
        {points && (
          <li>
            <svg width="10" height="8" aria-hidden="true">
              <circle cx="5" cy="4" r="3" fill={points.colour} />
            </svg>
            {points.name}
          </li>
        )}
        {band && (
          <li>
            <i className={styles.bandMark} />
            {band.name}
          </li>
        )}
        <li className={styles.reading}>
          {read !== undefined &&
            `${formatSi(hertz[read], "Hz")}: ${curves[0].db[read].toFixed(1)} dB, ${curves[0].deg[read].toFixed(0)}°`}
        </li>
      </ul>
      <div ref={element} className={styles.stage}>
        {size.width > 100 && size.height > 100 && (
          <svg
            width={size.width}
            height={size.height}
            role="img"
            aria-label={label}
            onPointerMove={(event) => {
              const share = (event.nativeEvent.offsetX - LEFT) / width;
              setAt(share < 0 || share > 1 ? undefined : low * (high / low) ** share);
            }}
            onPointerLeave={() => setAt(undefined)}
          >
            <BodePart
              left={LEFT}
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
              left={LEFT}
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
        )}
      </div>
    </div>
  );
}
