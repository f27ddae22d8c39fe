import type { ReactNode } from "react";
import styles from "./ui.module.css";

/** What an empty panel says: what would fill it, and an offer to do so. */
export function EmptyState({ title, children, action }: { title: string; children: ReactNode; action?: ReactNode }) {
  return (
    <div className={`column ${styles.empty}`}>
      <strong>{title}</strong>
      <p>{children}</p>
      {action}
    </div>
  );
}
