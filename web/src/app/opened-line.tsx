import { CloseButton } from "@mantine/core";
import { useState } from "react";
import { useBench } from "../stream/bench-store";
import styles from "./banner.module.css";

/** The version of a program and the first letters of the hash of its code. */
const brief = (version: string) => version.replace(/ (\w{7})\w*$/, " $1");

/** What came with the link a bench was opened by: its note, and whether the bits are still those of then. */
export function OpenedLine() {
  const opened = useBench((s) => s.bench?.opened);
  const bench = useBench((s) => s.bench?.id);
  const [dismissed, setDismissed] = useState<string | undefined>(undefined);
  if (!opened || dismissed === bench || (opened.same_bits && !opened.note)) return null;
  const other =
    opened.version === opened.version_now
      ? "This bench gives other bits here than where it was made."
      : `Made with ${brief(opened.version)}; this bench gives other bits today (${brief(opened.version_now)}).`;
  return (
    <section
      className={`row ${styles.banner}`}
      data-tone={opened.same_bits ? "hint" : "warn"}
      aria-label="Note of the link"
    >
      {opened.note && (
        <>
          <strong>Note:</strong>
          <span>{opened.note}</span>
        </>
      )}
      {!opened.same_bits && <span>{other}</span>}
      <div className={`line ${styles.actions}`}>
        <CloseButton size="sm" aria-label="Dismiss the note" onClick={() => setDismissed(bench)} />
      </div>
    </section>
  );
}
