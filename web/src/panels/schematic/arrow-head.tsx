import styles from "./schematic.module.css";

/** The head of a line with `markerEnd="url(#arrow)"`, in its colour. */
export function ArrowHead() {
  return (
    <defs>
      <marker id="arrow" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto">
        <path d="M0 0.5 L8 4 L0 7.5 Z" className={styles.head} />
      </marker>
    </defs>
  );
}
