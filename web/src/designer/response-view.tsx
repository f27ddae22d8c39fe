import { useMemo } from "react";
import type { Bode } from "../api/types";
import { decibels } from "../picture/bode/bode-data";
import { BodePlot } from "../picture/bode/bode-plot";
import styles from "./designer.module.css";

interface ResponseViewProps {
  bode: Bode;
  /** The drawing the process started from; the same as `bode` for a device as drawn. */
  drawing: Bode;
}

/** The Bode diagram of the device, and the band in which the process leaves devices of this drawing. */
export function ResponseView({ bode, drawing }: ResponseViewProps) {
  const shown = useMemo(() => {
    // both relative to the static gain of the drawing
    const shift = decibels(bode.static_gain_um_per_v / drawing.static_gain_um_per_v);
    const own = {
      name: "This device",
      slot: 1,
      dash: 0,
      hertz: bode.frequency_hz,
      db: bode.magnitude_db.nominal.map((db) => db + shift),
      deg: bode.phase_deg.nominal,
    };
    const band = { name: drawing.band, hertz: drawing.frequency_hz, db: drawing.magnitude_db, deg: drawing.phase_deg };
    if (drawing === bode) return { curves: [own], band };
    const nominal = {
      name: "As drawn",
      slot: 0,
      dash: 1,
      hertz: drawing.frequency_hz,
      db: drawing.magnitude_db.nominal,
      deg: drawing.phase_deg.nominal,
    };
    return { curves: [own, nominal], band };
  }, [bode, drawing]);
  return (
    <>
      <h2>Frequency response</h2>
      <div className={styles.bode}>
        <BodePlot label="Bode diagram with its tolerance band" shown={shown} />
      </div>
    </>
  );
}
