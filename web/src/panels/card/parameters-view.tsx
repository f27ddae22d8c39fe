import { useShallow } from "zustand/react/shallow";
import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { BlockValues } from "./block-values";
import styles from "./card.module.css";

/** The parameters of the controllers that drive, each under its name. */
export function ParametersView() {
  const active = useBench(useShallow((s) => Object.values(s.bench?.slots ?? {})));
  const { block } = useCatalog();
  if (active.length === 0)
    return <EmptyState title="No bench yet">The parameters of the active controller are set here.</EmptyState>;
  return (
    <section className={styles.card} aria-label="Parameters">
      {active.map((name) => (
        <section key={name} aria-label={block("control", name)?.title ?? name}>
          <h2 className={styles.title}>{block("control", name)?.title ?? name}</h2>
          <BlockValues id={`controllers.${name}`} />
        </section>
      ))}
    </section>
  );
}
