import { useShallow } from "zustand/react/shallow";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatShort } from "../../ui/format";
import { AxesLoop } from "./axes-loop";
import { ResonatorLoop } from "./resonator-loop";
import styles from "./schematic.module.css";
import { useActingFaults } from "./use-live-values";
import { useStructure } from "./use-structure";

/** The loop with what flows in it now; a box opens its card. */
export function SchematicPanel() {
  const device = useBench((s) => (s.bench?.parameters.device as { id?: string } | undefined)?.id);
  const axes = useBench((s) => s.bench?.axes);
  const slots = useBench(useShallow((s) => s.bench?.slots));
  const controller = useBench((s) => s.bench?.controller);
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const rate = useBench((s) => s.bench?.sample_rate_khz);
  const structure = useStructure();
  const acting = useActingFaults();
  if (!axes || !slots || !controller || !diagnosers)
    return <EmptyState title="No bench yet">The loop appears with the bench.</EmptyState>;
  const isFlat = axes.length === 0;
  return (
    <section className={styles.panel} aria-label="The loop">
      {isFlat ? (
        <ResonatorLoop controller={controller} diagnosers={diagnosers} structure={structure} />
      ) : (
        <AxesLoop axes={axes} slots={slots} />
      )}
      <p className={styles.device}>
        {device ?? "device"} · {rate === undefined ? "" : formatShort(rate, "kHz")}
        {isFlat && structure.figure && ` · drawn as figure ${structure.figure}`}
        {isFlat && !structure.hasRoom && acting.length > 0 && (
          <span className={styles.acting}> · {acting.map((fault) => fault.title).join(", ")}</span>
        )}
      </p>
    </section>
  );
}
