import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { DiagnoserLanes } from "./diagnoser-lanes";
import styles from "./lanes.module.css";

/** Every diagnoser of the bench: what it believes, against what is true. */
export function LanesPanel() {
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const entries = Object.entries(diagnosers ?? {});
  if (entries.length === 0)
    return (
      <EmptyState title="No diagnoser on this bench">
        Open a scenario of chapter 5 from New bench; its bank of Kalman filters fills these lanes.
      </EmptyState>
    );
  return (
    <div className={styles.panel}>
      {entries.map(([id, { names }]) => (
        <DiagnoserLanes key={id} id={id} names={names} />
      ))}
    </div>
  );
}
