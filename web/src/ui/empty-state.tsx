import type { ReactNode } from "react";
import styles from "./ui.module.css";

/** The text of an empty panel: its future contents, and a button that creates them. */
export function EmptyState({ title, children, action }: { title: string; children: ReactNode; action?: ReactNode }) {
  return (
    <div className={`column ${styles.empty}`}>
      <strong>{title}</strong>
      <p>{children}</p>
      {action}
    </div>
  );
}
