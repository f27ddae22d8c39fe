import { useMemo } from "react";
import type { Identification } from "../../api/types";
import { decibels } from "../../picture/bode/bode-data";
import { BodePlot } from "../../picture/bode/bode-plot";

/** The measured tones over the fitted response and the nominal one. */
export function SweepBode({ result }: { result: Identification }) {
  const shown = useMemo(() => {
    const { curve, tones, nominal } = result;
    const rest = Math.abs(nominal.static_gain_um_per_v);
    const hertz = curve.frequency_hz;
    return {
      curves: [
        {
          name: "Fitted",
          slot: 1,
          dash: 0,
          hertz,
          db: curve.found_um_per_v.map((gain) => decibels(gain / rest)),
          deg: curve.found_deg,
        },
        {
          name: "Nominal",
          slot: 0,
          dash: 1,
          hertz,
          db: curve.nominal_um_per_v.map((gain) => decibels(gain / rest)),
          deg: curve.nominal_deg,
        },
      ],
      points: {
        name: `${tones.length} tones measured`,
        slot: 2,
        hertz: tones.map((t) => t.frequency_hz),
        db: tones.map((t) => decibels(t.gain_um_per_v / rest)),
        // 20 log10(1 + e) is 8.686 e
        errorDb: tones.map((t) => (8.686 * t.error_um_per_v) / t.gain_um_per_v),
        deg: tones.map((t) => t.phase_deg),
      },
    };
  }, [result]);
  return <BodePlot label="Measured tones over the fitted response" shown={shown} />;
}
