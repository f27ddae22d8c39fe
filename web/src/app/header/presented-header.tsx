import { ActionIcon } from "@mantine/core";
import { IconX } from "@tabler/icons-react";
import { useLecture } from "../../bench/lecture";
import { useSteps } from "../../bench/steps";
import { useBench } from "../../stream/bench-store";
import { setPresent } from "../present";
import { StepWords } from "../step-bar";
import { DeviceClock } from "./device-clock";
import styles from "./header.module.css";
import { StateBadge } from "./state-badge";

/** The strip along the top for an audience: what runs, which step it is at, its state and its time. */
export function PresentedHeader() {
  const bench = useBench((s) => s.bench);
  const steps = useSteps();
  // what comes next in a lecture is asked before it is shown
  const lectures = useLecture((s) => s.lecture !== undefined);
  return (
    <header className={`${styles.header} ${styles.presented}`}>
      <h1>{bench?.title ?? "CombBench"}</h1>
      {bench && !lectures && steps.length > 1 && <StepWords bench={bench} steps={steps} />}
      <StateBadge />
      <DeviceClock />
      <ActionIcon
        size={34}
        variant="subtle"
        aria-label="Leave the presentation"
        title="Leave the presentation (Escape)"
        onClick={() => setPresent(false)}
      >
        <IconX size={19} />
      </ActionIcon>
    </header>
  );
}
