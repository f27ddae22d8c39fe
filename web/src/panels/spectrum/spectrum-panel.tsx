import { NativeSelect } from "@mantine/core";
import { useRef, useState } from "react";
import { PictureMenu, type TakePicture } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatSi } from "../../ui/format";
import styles from "../phase/phase.module.css";
import { bandItems, tickItems } from "./spectrum-menus";
import { SpectrumPlot } from "./spectrum-plot";

/** The tones in a signal, live: every tick of the window counts, so nothing beyond the band folds back into it. */
export function SpectrumPanel() {
  const signals = useBench((s) => s.bench?.signals);
  const dtMs = useBench((s) => s.bench?.dt_ms);
  const [wanted, setSignal] = useState<string | undefined>(undefined);
  const [ticks, setTicks] = useState(4096);
  const [share, setShare] = useState(5);
  const picture = useRef<TakePicture>(null);
  if (!signals || !dtMs)
    return <EmptyState title="No bench yet">The tones of a signal appear as soon as a bench is connected.</EmptyState>;
  const usual = signals.find((s) => s.name === "sensor.displacement" || s.name === "sensor.x.displacement");
  const signal = wanted ?? usual?.name ?? signals[0].name;
  return (
    <section className={`view ${styles.panel}`} aria-label="Spectrum">
      <div className={`row ${styles.bar}`}>
        <NativeSelect
          aria-label="Signal"
          value={signal}
          data={signals.map((s) => ({ value: s.name, label: s.name.replaceAll("_", " ").replace(".", " · ") }))}
          onChange={(e) => setSignal(e.currentTarget.value)}
        />
        <NativeSelect
          aria-label="Length of the record"
          value={String(ticks)}
          data={tickItems()}
          onChange={(e) => setTicks(Number(e.currentTarget.value))}
        />
        <NativeSelect
          aria-label="Band"
          value={String(share)}
          data={bandItems(dtMs)}
          onChange={(e) => setShare(Number(e.currentTarget.value))}
        />
        <span className={styles.held}>bins of {formatSi(1 / (ticks * dtMs), "kHz", 3)}, Hann window</span>
        <PictureMenu take={() => picture.current?.()} />
      </div>
      <SpectrumPlot signal={signal} ticks={ticks} dtMs={dtMs} highest={0.5 / dtMs / share} picture={picture} />
    </section>
  );
}
