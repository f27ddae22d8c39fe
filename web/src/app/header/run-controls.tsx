import { ActionIcon, Tooltip } from "@mantine/core";
import {
  IconPlayerPauseFilled,
  IconPlayerPlayFilled,
  IconPlayerSkipForward,
  IconPlayerTrackNext,
  IconRotate,
} from "@tabler/icons-react";
import type { ReactNode } from "react";
import { actions } from "../../bench/actions";
import { useBench } from "../../stream/bench-store";
import { useBoardState } from "../../stream/freshness";
import styles from "./header.module.css";

/** Run, pause, step a tick, step a period, reset. */
export function RunControls() {
  const state = useBoardState();
  const unknown = state === undefined;
  const running = state === "running";
  const stuck = state === "tripped" || unknown;
  const period = useBench((s) => s.bench?.drive_period_ticks ?? null);
  return (
    <div className={styles.run}>
      <Tooltip label={running ? "Pause (space)" : "Run (space)"}>
        <ActionIcon
          size={38}
          radius="xl"
          variant="filled"
          color="accent"
          aria-label={running ? "Pause" : "Run"}
          disabled={stuck}
          onClick={actions.toggle}
        >
          {running ? <IconPlayerPauseFilled size={20} /> : <IconPlayerPlayFilled size={20} />}
        </ActionIcon>
      </Tooltip>
      <Small label="One tick ( . )" name="Step one tick" onClick={actions.stepTick} disabled={stuck}>
        <IconPlayerSkipForward size={18} />
      </Small>
      <Small
        label={period === null ? "The drive has no period of its own" : "One drive period ( , )"}
        name="Step one period"
        onClick={actions.stepPeriod}
        disabled={stuck || period === null}
      >
        <IconPlayerTrackNext size={18} />
      </Small>
      <Small label="Reset to the start (shift R)" name="Reset" onClick={actions.reset} disabled={unknown}>
        <IconRotate size={18} />
      </Small>
    </div>
  );
}

function Small(props: { label: string; name: string; disabled?: boolean; onClick(): void; children: ReactNode }) {
  return (
    <Tooltip label={props.label}>
      <ActionIcon size={32} variant="subtle" aria-label={props.name} disabled={props.disabled} onClick={props.onClick}>
        {props.children}
      </ActionIcon>
    </Tooltip>
  );
}
