import { IconAdjustments, IconCheck, IconChecks, IconCircleHalf2, IconFlask, IconX } from "@tabler/icons-react";
import styles from "./verdict.module.css";

/** The verdicts from best to worst, and the word for a figure that the dissertation does not claim. */
const MARKS = {
  reproduced: { tone: "good", icon: <IconCheck size={13} stroke={2.6} /> },
  "reproduced by tuning": { tone: "good", icon: <IconAdjustments size={13} stroke={2.2} /> },
  "reproduced, by a PID too": { tone: "good", icon: <IconChecks size={13} stroke={2.2} /> },
  "reproduced by tuning, by a PID too": { tone: "good", icon: <IconAdjustments size={13} stroke={2.2} /> },
  partly: { tone: "fair", icon: <IconCircleHalf2 size={13} stroke={2.2} /> },
  "not reproduced": { tone: "poor", icon: <IconX size={13} stroke={2.6} /> },
  ours: { tone: "own", icon: <IconFlask size={13} stroke={2.2} /> },
};

export const VERDICTS = Object.keys(MARKS);

interface VerdictProps {
  verdict: string | null;
  /** Whether a run confirms it; an unconfirmed claim has no mark and no colour. */
  borneOut: boolean;
}

/** The verdict on a claim: a word, a mark of its own shape, a colour. */
export function Verdict({ verdict, borneOut }: VerdictProps) {
  const known = verdict !== null && verdict in MARKS ? MARKS[verdict as keyof typeof MARKS] : undefined;
  // our own experiments are no claims
  if (known && !borneOut)
    return (
      <span className={styles.verdict}>
        {verdict === "ours" ? "" : "claim: "}
        {verdict}
      </span>
    );
  return (
    <span className={styles.verdict} data-tone={known?.tone}>
      {known?.icon}
      {verdict ?? "no claim"}
    </span>
  );
}
