import type { ReactNode } from "react";
import type { LegendEntry } from "./legend";
import styles from "./legend-list.module.css";

/** Names after their colours, as the page writes them beside a plot. */
export function Legend({ entries, children }: { entries: readonly LegendEntry[]; children?: ReactNode }) {
  if (entries.length === 0 && !children) return null;
  return (
    <ul className={styles.legend}>
      {entries.map(({ name, colour, dashes = [], mark }) => (
        <li key={name}>
          <svg width="24" height="10" aria-hidden="true">
            {mark === "dot" ? (
              <circle cx="12" cy="5" r="3.5" fill={colour} />
            ) : mark === "cross" ? (
              <path d="M7.5 .5l9 9m0 -9l-9 9" stroke={colour} strokeWidth="2" />
            ) : mark === "field" ? (
              <rect width="24" height="10" rx="2" fill={colour} />
            ) : (
              <path d="M0 5H24" stroke={colour} strokeWidth="2.2" strokeDasharray={dashes.join(" ")} />
            )}
          </svg>
          {name}
        </li>
      ))}
      {children}
    </ul>
  );
}
