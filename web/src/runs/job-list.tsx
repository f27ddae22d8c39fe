import { ActionIcon, Progress } from "@mantine/core";
import { IconPlayerStopFilled } from "@tabler/icons-react";
import { api } from "../api/api";
import type { Run, SweepRun } from "../api/types";
import { showError } from "../bench/send";
import { formatCount, formatNumber } from "../ui/format";
import styles from "./runs.module.css";
import type { Chosen } from "./use-chosen";

interface Common {
  id: string;
  title: string;
  /** What it consists of, in a few words. */
  about: string;
  state: string;
  created: string;
  progress: number;
  isActive: boolean;
}

export type Job = Common & ({ kind: "run"; run: Run } | { kind: "campaign"; sweep: SweepRun });

const isActive = (state: string) => state === "queued" || state === "running";

/** Runs and campaigns as one list, newest first. */
export function jobsOf(runs: readonly Run[], sweeps: readonly SweepRun[]): Job[] {
  return [
    ...runs.map(
      (run): Job => ({
        kind: "run",
        run,
        id: run.id,
        title: run.title || run.scenario_id,
        about: `${run.scenario_id} · ${run.seeds.length > 1 ? formatCount(run.seeds.length, "seed") : `seed ${run.seeds[0]}`}`,
        state: run.state,
        created: run.created,
        progress: run.progress,
        isActive: isActive(run.state),
      }),
    ),
    ...sweeps.map(
      (sweep): Job => ({
        kind: "campaign",
        sweep,
        id: sweep.id,
        title: sweep.title || `Campaign ${sweep.name}`,
        about: `${formatNumber(sweep.done ?? 0, 0)} of ${formatCount(sweep.runs, "run")}`,
        state: sweep.state,
        created: sweep.created,
        progress: sweep.runs ? (sweep.done ?? 0) / sweep.runs : 0,
        isActive: isActive(sweep.state),
      }),
    ),
  ].sort((a, b) => Date.parse(b.created) - Date.parse(a.created));
}

interface JobListProps {
  jobs: Job[];
  chosen: Chosen | undefined;
  onChoose(chosen: Chosen): void;
  onChanged(): void;
}

/** Everything that was asked for, newest first; what is under way shows how far it is. */
export function JobList({ jobs, chosen, onChoose, onChanged }: JobListProps) {
  const cancel = (job: Job) =>
    (job.kind === "run" ? api.cancelRun(job.id) : api.cancelSweep(job.id)).then(onChanged, showError);
  return (
    <ul className={styles.list}>
      {jobs.map((job) => (
        <li key={job.kind + job.id} data-chosen={job.id === chosen?.id}>
          <button
            type="button"
            aria-current={job.id === chosen?.id ? "true" : undefined}
            onClick={() => onChoose({ kind: job.kind, id: job.id })}
          >
            <b>{job.title}</b>
            <span>{job.about}</span>
            <span
              className={styles.state}
              data-state={job.state}
              data-ok={job.kind === "run" ? job.run.summary?.ok === true : undefined}
            >
              {stateText(job)}
            </span>
            <time dateTime={job.created}>{new Date(job.created).toLocaleTimeString([], { timeStyle: "short" })}</time>
            {job.state === "running" && (
              <Progress value={job.progress * 100} size="sm" w="100%" aria-label={`Progress of ${job.title}`} />
            )}
          </button>
          {job.isActive && (
            <ActionIcon
              size={28}
              variant="subtle"
              color="alarm"
              aria-label={`Cancel ${job.title}`}
              title={job.kind === "run" ? "Cancel" : "Stop here; what is done stays, and starting it again goes on"}
              onClick={() => cancel(job)}
            >
              <IconPlayerStopFilled size={15} />
            </ActionIcon>
          )}
        </li>
      ))}
    </ul>
  );
}

function stateText(job: Job): string {
  if (job.state !== "done" || job.kind === "campaign") return job.state;
  const summary = job.run.summary as { ok?: boolean; trip?: unknown; expectations?: unknown[] } | null;
  if (summary?.trip) return "tripped";
  if (!summary?.expectations?.length) return "done";
  return summary.ok ? "as expected" : "other than expected";
}
