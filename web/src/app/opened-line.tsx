import { CloseButton } from "@mantine/core";
import { useState } from "react";
import { useBench } from "../stream/bench-store";
import { NoticeLine } from "./notice-line";

/** The version of a program and the first letters of the hash of its code. */
const brief = (version: string) => version.replace(/ (\w{7})\w*$/, " $1");

/** The note of the link of a bench, and a warning if the bits differ from the time of the link. */
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
    <NoticeLine
      label="Note of the link"
      tone={opened.same_bits ? "note" : "warn"}
      title={opened.note && "Note:"}
      text={[opened.note, !opened.same_bits && other].filter(Boolean).join(" ")}
    >
      <CloseButton size="sm" aria-label="Dismiss the note" onClick={() => setDismissed(bench)} />
    </NoticeLine>
  );
}
