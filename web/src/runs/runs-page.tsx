import { useCallback, useEffect, useRef } from "react";
import { api } from "../api/api";
import { useAnswer } from "../api/use-answer";
import { EmptyState } from "../ui/empty-state";
import { Stale } from "../ui/stale";
import { CampaignDetail } from "./campaign-detail";
import { type Job, JobList, jobsOf } from "./job-list";
import { RunDetail } from "./run-detail";
import styles from "./runs.module.css";
import { StartForm } from "./start-form";
import { useChosen } from "./use-chosen";

const BUSY_MS = 700;
const CALM_MS = 15_000;

async function ask(): Promise<Job[]> {
  const [runs, sweeps] = await Promise.all([api.runs(), api.sweeps()]);
  return jobsOf(runs, sweeps);
}

/** Headless runs and campaigns: start them, watch them, read what they gave. */
export function RunsPage() {
  const { value, error, since, again } = useAnswer(ask, (jobs) =>
    jobs?.some((job) => job.isActive) ? BUSY_MS : CALM_MS,
  );
  const [chosen, choose] = useChosen();
  const job = value?.find((one) => one.kind === chosen?.kind && one.id === chosen.id);
  const detail = useRef<HTMLElement>(null);
  // Where the result stands below the list it comes into view when it is chosen.
  useEffect(() => {
    if (chosen?.id) detail.current?.scrollIntoView({ block: "nearest" });
  }, [chosen?.id]);
  const started = useCallback(
    (next: Parameters<typeof choose>[0]) => {
      choose(next);
      again();
    },
    [choose, again],
  );
  return (
    <main className={styles.page}>
      <section className={styles.start} aria-label="Start a run">
        <h1>Runs and campaigns</h1>
        <StartForm onStarted={started} />
      </section>
      <section className={styles.jobs} aria-label="Runs and campaigns">
        <Stale error={error} since={since} onRetry={again} />
        {value && value.length > 0 ? (
          <JobList jobs={value} chosen={chosen} onChoose={choose} onChanged={again} />
        ) : (
          !error && (
            <EmptyState title={value ? "Nothing has been run yet" : "Asking the server"}>
              Start a run beside this list, or run an experiment from the gallery.
            </EmptyState>
          )
        )}
      </section>
      <section ref={detail} className={styles.detail} aria-label="Result">
        {job?.kind === "run" ? (
          <RunDetail key={job.id} run={job.run} />
        ) : job?.kind === "campaign" ? (
          <CampaignDetail key={job.id} sweep={job.sweep} />
        ) : (
          <EmptyState title={chosen && value ? "That one is not here" : "No result chosen"}>
            Choose a run or a campaign from the list: figures, expectations, reports and downloads appear here.
          </EmptyState>
        )}
      </section>
    </main>
  );
}
