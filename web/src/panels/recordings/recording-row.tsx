import { ActionIcon, Button } from "@mantine/core";
import { IconPlayerPlay, IconTrash } from "@tabler/icons-react";
import { useState } from "react";
import { api } from "../../api/api";
import type { Recording } from "../../api/types";
import { openReplay } from "../../app/replay-bar";
import { showError } from "../../app/send";
import { Downloads, TRACE_FORMATS } from "../../ui/downloads";
import { formatNumber } from "../../ui/format";
import styles from "./recordings.module.css";

interface RecordingRowProps {
  recording: Recording;
  /** Of the bench on the page. */
  isHere: boolean;
  onCompare(): void;
  onChanged(): void;
}

/** One recording: what it is, and what can be done with it. */
export function RecordingRow({ recording, isHere, onCompare, onChanged }: RecordingRowProps) {
  const [busy, setBusy] = useState(false);
  const { id, name, state, ticks, dt_ms, start_tick, condition, created, bytes, reason, signals } = recording;
  const open = state === "armed" || state === "recording";
  const play = async () => {
    setBusy(true);
    await openReplay(id).catch(showError);
    setBusy(false);
  };
  const remove = () => {
    if (window.confirm(`Delete the recording ${name} of ${formatNumber(ticks * dt_ms, 2)} ms for good?`))
      api.removeRecording(id).then(onChanged, showError);
  };
  return (
    <li className={styles.row} data-state={state}>
      <div className={styles.what}>
        <b>{name}</b>
        <span>
          {state === "armed"
            ? `waits for ${condition}`
            : open
              ? "is being recorded"
              : `${formatNumber(ticks * dt_ms, 2)} ms from ${formatNumber(start_tick * dt_ms, 2)} ms`}
          {!open && ` · ${signals.length} signals · ${formatNumber(bytes / 1e6, 1)} MB`}
          {condition && state !== "armed" && ` · ${condition}`}
        </span>
        <span>
          {isHere ? "this bench" : "another bench"},{" "}
          {new Date(created).toLocaleString([], { dateStyle: "short", timeStyle: "short" })}
          {state === "aborted" || state === "failed" ? (
            <em>
              {" "}
              · {state}: {reason}
            </em>
          ) : null}
        </span>
      </div>
      {!open && (
        <div className={styles.do}>
          <Downloads href={(format) => `/api/v1/recordings/${id}/trace?format=${format}`} formats={TRACE_FORMATS} />
          <Button
            size="compact-xs"
            variant="light"
            loading={busy}
            leftSection={<IconPlayerPlay size={13} />}
            onClick={play}
            aria-label={`Replay ${name}`}
          >
            Replay
          </Button>
          <Button size="compact-xs" variant="default" onClick={onCompare} aria-label={`Compare ${name} with another`}>
            Compare
          </Button>
          <ActionIcon size={22} variant="subtle" aria-label={`Delete ${name}`} onClick={remove}>
            <IconTrash size={14} />
          </ActionIcon>
        </div>
      )}
    </li>
  );
}
