import { Box as Place } from "@mantine/core";
import { useCallback, useState } from "react";
import { formatIn, formatSi } from "../../ui/format";
import { useScheme } from "../../ui/use-canvas";
import { placeOn } from "../axes";
import { Legend } from "../legend-list";
import { Painted } from "../painted";
import type { Box, Look, Pen } from "../pen";
import { fileStem } from "../picture";
import { PictureMenu } from "../picture-menu";
import styles from "./bode.module.css";
import { nearest } from "./bode-data";
import { type BodeShown, bodeEntries, paintBode } from "./paint-bode";

/** Magnitude over phase, on one logarithmic axis of frequency; the pointer reads both. */
export function BodePlot({ label, shown }: { label: string; shown: BodeShown }) {
  const scheme = useScheme();
  const [read, setRead] = useState<number | undefined>(undefined);
  const paint = useCallback((pen: Pen, box: Box, look: Look) => paintBode(pen, box, shown, look, read), [shown, read]);
  const [first] = shown.curves;
  const { hertz } = first;
  const take = () => ({
    title: label,
    stem: fileStem(label),
    legend: bodeEntries(shown, "light"),
    height: 460,
    paint: (pen: Pen, box: Box, look: Look) => paintBode(pen, box, shown, look),
  });
  return (
    <div className={`column ${styles.plot}`}>
      <Legend entries={bodeEntries(shown, scheme)}>
        <li className={styles.reading}>
          {read !== undefined &&
            `${formatSi(hertz[read], "Hz")}: ${formatIn(first.db[read], "dB", 1)}, ${formatIn(first.deg[read], "°", 0)}`}
        </li>
        <li>
          <PictureMenu name={label} take={take} />
        </li>
      </Legend>
      <Place flex={1} mih={180}>
        <Painted
          label={label}
          paint={paint}
          onPoint={(at, { field: { left, right } }) => {
            const ends = { range: [left, right] as const };
            const share = at && placeOn(ends, 0, 1)(at.x);
            const isWithin = share !== undefined && share >= 0 && share <= 1;
            setRead(isWithin ? nearest(hertz, hertz[0] * (hertz[hertz.length - 1] / hertz[0]) ** share) : undefined);
          }}
        />
      </Place>
    </div>
  );
}
