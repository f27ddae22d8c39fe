import { useMemo } from "react";
import type { Bode } from "../api/types";
import { useScheme } from "../app/use-scheme";
import { BodePlot } from "../ui/bode/bode-plot";
import { TRACE_COLOURS } from "../ui/palette";
import styles from "./designer.module.css";

/** The Bode diagram of the device, and the band in which its like would lie. */
export function ResponseView({ bode }: { bode: Bode }) {
  const scheme = useScheme();
  const curves = useMemo(
    () => [
      {
        name: "This device",
        colour: TRACE_COLOURS[scheme][1],
        hertz: bode.frequency_hz,
        db: bode.magnitude_db.nominal,
        deg: bode.phase_deg.nominal,
      },
    ],
    [bode, scheme],
  );
  const band = useMemo(
    () => ({ name: bode.band, hertz: bode.frequency_hz, db: bode.magnitude_db, deg: bode.phase_deg }),
    [bode],
  );
  return (
    <>
      <h2 className={styles.heading}>Frequency response</h2>
      <div className={styles.bode}>
        <BodePlot label="Bode diagram with its tolerance band" curves={curves} band={band} />
      </div>
    </>
  );
}
