import { useBench } from "../../stream/bench-store";
import { sentence } from "../../ui/capital";
import { formatSi } from "../../ui/format";
import styles from "./instrument.module.css";

/** The instrument that the bench plays: its rate, its lag, and the losses on the way. */
export function Instrument() {
  const one = useBench((s) => s.bench?.instrument);
  if (!one) return null;
  const state = !one.is_growing ? sentence(one.ended) : one.is_connected ? "" : "It is gone; the bench waits.";
  const latency = one.latency_p95_ms;
  const counts: [string, string | number][] = [
    ["Rate", formatSi(one.received_khz, "kHz", 3)],
    ["Lag", formatSi(one.lag_ms, "ms", 2)],
    ["Verdict after", latency === null ? "none yet" : formatSi(latency, "ms", 2)],
    ["Lost blocks", one.lost_blocks],
    ["Late", one.late_blocks],
    ["Doubled", one.doubled_blocks],
    ["Lost samples", one.lost_samples],
    ["Breaks", one.breaks],
  ];
  return (
    <section aria-label="Instrument">
      <h2>{one.source}, live</h2>
      {state && <p role="status">{state}</p>}
      <dl className={styles.counts}>
        {counts.map(([name, value]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd data-lost={value !== 0 && typeof value === "number"}>{value}</dd>
          </div>
        ))}
      </dl>
    </section>
  );
}
