import { Group, NativeSelect } from "@mantine/core";
import { useRef, useState } from "react";
import { PictureMenu } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatSi } from "../../ui/format";
import styles from "../phase/phase.module.css";
import { type SpectrumShown, spectrumPicture } from "./paint-spectrum";
import { bandItems, tickItems } from "./spectrum-menus";
import { SpectrumPlot } from "./spectrum-plot";

/** The tones in a signal, live: every tick of the window counts, so nothing beyond the band folds back into it. */
export function SpectrumPanel() {
  const signals = useBench((s) => s.bench?.signals);
  const dtMs = useBench((s) => s.bench?.dt_ms);
  const [wanted, setSignal] = useState<string | undefined>(undefined);
  const [ticks, setTicks] = useState(4096);
  const [share, setShare] = useState(5);
  const shown = useRef<SpectrumShown | undefined>(undefined);
  if (!signals || !dtMs)
    return <EmptyState title="No bench yet">The tones of a signal appear as soon as a bench is connected.</EmptyState>;
  const usual = signals.find((s) => s.name === "sensor.displacement" || s.name === "sensor.x.displacement");
  const signal = wanted ?? usual?.name ?? signals[0].name;
  return (
    <section className={`view ${styles.panel}`} aria-label="Spectrum">
      <Group gap="6px 8px" p="6px 12px">
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
        <span className="note">bins of {formatSi(1 / (ticks * dtMs), "kHz", 3)}, Hann window</span>
        <PictureMenu take={() => shown.current && spectrumPicture(shown.current, signal.replaceAll(/[._]/g, " "))} />
      </Group>
      <SpectrumPlot signal={signal} ticks={ticks} dtMs={dtMs} highest={0.5 / dtMs / share} shown={shown} />
    </section>
  );
}
