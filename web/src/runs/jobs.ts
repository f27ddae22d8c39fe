import type { Run, SweepRun } from "../api/types";
import { formatCount, formatNumber } from "../ui/format";

interface Common {
  id: string;
  /** Its given name, else its title. */
  title: string;
  /** Its contents, in a few words. */
  about: string;
  state: string;
  created: string;
  progress: number;
  isActive: boolean;
}

/** A run or a campaign in the list. */
export type Job = Common & ({ kind: "run"; run: Run } | { kind: "campaign"; sweep: SweepRun });

export const isActive = (state: string) => state === "queued" || state === "running";

/** The name of a run. */
export const runName = (run: Run): string => run.label || run.title || run.scenario_id;

/** The name of a campaign. */
export const sweepName = (sweep: SweepRun): string => sweep.label || sweep.title || `Campaign ${sweep.name}`;

/** The seeds of a run in words. */
export const seedText = (run: Run): string =>
  run.seeds.length > 1 ? formatCount(run.seeds.length, "seed") : `seed ${run.seeds[0]}`;

const commonOf = ({ id, state, created }: Run | SweepRun) => ({ id, state, created, isActive: isActive(state) });

/** Runs and campaigns as one list, newest first. */
export function jobsOf(runs: readonly Run[], sweeps: readonly SweepRun[]): Job[] {
  return [
    ...runs.map(
      (run): Job => ({
        kind: "run",
        run,
        ...commonOf(run),
        title: runName(run),
        about: `${run.scenario_id} · ${seedText(run)}`,
        progress: run.progress,
      }),
    ),
    ...sweeps.map(
      (sweep): Job => ({
        kind: "campaign",
        sweep,
        ...commonOf(sweep),
        title: sweepName(sweep),
        about: `${sweep.name} · ${formatNumber(sweep.done ?? 0, 0)} of ${formatCount(sweep.runs, "run")}`,
        progress: sweep.runs ? (sweep.done ?? 0) / sweep.runs : 0,
      }),
    ),
  ].sort((a, b) => Date.parse(b.created) - Date.parse(a.created));
}

/** The state of a job, in words. */
export function stateText(job: Job): string {
  if (job.state !== "done" || job.kind === "campaign") return job.state;
  const { summary } = job.run;
  if (summary?.trip) return "tripped";
  if (!summary?.expectations.length) return "done";
  return summary.ok ? "as expected" : "other than expected";
}
