import { ActionIcon, Box, Button } from "@mantine/core";
import { IconPlayerPlay, IconTrash } from "@tabler/icons-react";
import { api } from "../../api/api";
import { useMay } from "../../api/me";
import type { Recording } from "../../api/types";
import { openReplay } from "../../bench/open-bench";
import { showError } from "../../bench/send";
import { useBusy } from "../../bench/use-busy";
import { Downloads, TRACE_FORMATS } from "../../ui/downloads";
import { formatCount, formatMoment, formatSi } from "../../ui/format";
import rows from "../../ui/row-list.module.css";

/** The end of a recording that failed. */
const ENDED: Partial<Record<Recording["state"], string>> = {
  cut_short: "was cut short",
  failed: "holds nothing",
  aborted: "was interrupted",
};

const EDGE: Partial<Record<Recording["state"], string>> = {
  recording: "3px solid var(--alarm)",
  armed: "3px solid var(--paused)",
};

interface RecordingRowProps {
  recording: Recording;
  /** Of the bench on the page. */
  isHere: boolean;
  onCompare(): void;
  onChanged(): void;
}

/** One recording: its facts and its actions. */
export function RecordingRow({ recording, isHere, onCompare, onChanged }: RecordingRowProps) {
  const [busy, during] = useBusy();
  const teaches = useMay("teach");
  const { id, name, state, ticks, dt_ms, start_tick, condition, created, bytes, reason, signals } = recording;
  const open = state === "armed" || state === "recording";
  const play = () => during(() => openReplay(id));
  const remove = () => {
    if (window.confirm(`Delete the recording ${name} of ${formatSi(ticks * dt_ms, "ms")} for good?`))
      api.removeRecording(id).then(onChanged, showError);
  };
  return (
    <li className={rows.row} style={{ borderLeft: EDGE[state] }}>
      <div className={rows.what}>
        <b>{name}</b>
        <span>
          {state === "armed"
            ? `waits for ${condition}`
            : open
              ? "is being recorded"
              : `${formatSi(ticks * dt_ms, "ms")} from ${formatMoment(start_tick * dt_ms)}`}
          {!open && ` · ${formatCount(signals.length, "signal")} · ${formatSi(bytes, "B", 3)}`}
          {condition && state !== "armed" && ` · ${condition}`}
        </span>
        <span>
          {isHere ? "this bench" : "another bench"},{" "}
          {new Date(created).toLocaleString([], { dateStyle: "short", timeStyle: "short" })}
          {ENDED[state] && (
            <Box component="em" c="var(--alarm)" fs="normal">
              {" "}
              · {ENDED[state]}: {reason}
            </Box>
          )}
        </span>
      </div>
      {!open && (
        <div className={`row ${rows.do}`}>
          <Downloads href={(format) => `./api/v1/recordings/${id}/trace?format=${format}`} formats={TRACE_FORMATS} />
          {teaches && (
            <>
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
              <Button size="compact-xs" onClick={onCompare} aria-label={`Compare ${name} with another`}>
                Compare
              </Button>
              <ActionIcon size={22} aria-label={`Delete ${name}`} onClick={remove}>
                <IconTrash size={14} />
              </ActionIcon>
            </>
          )}
        </div>
      )}
    </li>
  );
}
