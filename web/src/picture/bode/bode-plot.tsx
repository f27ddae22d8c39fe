import { useState } from "react";
import { formatIn, formatSi } from "../../ui/format";
import { useSize } from "../../ui/use-size";
import { PictureMenu } from "../picture-menu";
import styles from "./bode.module.css";
import { BodeField, type BodeFieldProps } from "./bode-field";
import { printBode } from "./print-bode";

type BodePlotProps = Pick<BodeFieldProps, "label" | "curves" | "band" | "points" | "degrees">;

/** Magnitude over phase, on one logarithmic axis of frequency; the pointer reads both. */
export function BodePlot({ label, ...shown }: BodePlotProps) {
  const { element, size } = useSize<HTMLDivElement>();
  const [read, setRead] = useState<number | undefined>(undefined);
  const { curves, band, points } = shown;
  const hertz = curves[0].hertz;
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
            `${formatSi(hertz[read], "Hz")}: ${formatIn(curves[0].db[read], "dB", 1)}, ${formatIn(curves[0].deg[read], "°", 0)}`}
        </li>
        <li>
          <PictureMenu name={label} take={() => printBode(label, shown)} />
        </li>
      </ul>
      <div ref={element} className={styles.stage}>
        {size.width > 100 && size.height > 100 && (
          <BodeField label={label} {...shown} {...size} read={read} onRead={setRead} />
        )}
      </div>
    </div>
  );
}
