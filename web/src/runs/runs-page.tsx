import { Button, Stack } from "@mantine/core";
import { useDebouncedValue } from "@mantine/hooks";
import { useCallback, useEffect, useRef, useState } from "react";
import { api } from "../api/api";
import type { Rows } from "../api/client";
import { useAnswer, useList } from "../api/queries";
import type { RunFilter } from "../api/types";
import { PageHead } from "../bench/page-head";
import { showError } from "../bench/send";
import { EmptyState } from "../ui/empty-state";
import { ShowOlder } from "../ui/show-older";
import { Stale } from "../ui/stale";
import { CampaignDetail } from "./campaign-detail";
import { JobFilter } from "./job-filter";
import { JobList } from "./job-list";
import { type Job, jobsOf } from "./jobs";
import { RunComparison } from "./run-comparison";
import { RunDetail } from "./run-detail";
import styles from "./runs.module.css";
import { StartForm } from "./start-form";
import { useChosen } from "./use-chosen";

const BUSY_MS = 700;
const CALM_MS = 15_000;

/** Pause in typing after which the list is asked for. */
const PAUSE_MS = 250;
const ALL: RunFilter = {};

/** The newest runs and campaigns of both lists. */
async function jobsLike(filter: RunFilter, most: number): Promise<Rows<Job>> {
  const [runs, sweeps] = await Promise.all([api.newestRuns(filter, most), api.newestSweeps(filter, most)]);
  const jobs = jobsOf(runs.rows, sweeps.rows);
  return { rows: jobs.slice(0, most), isWhole: runs.isWhole && sweeps.isWhole && jobs.length <= most };
}

/** A run or a campaign by its id: a link may lead to a result that is older than the rows of the list. */
const jobOf = (id: string): Promise<Job> =>
  api.run(id).then(
    (run) => jobsOf([run], [])[0],
    async () => jobsOf([], [await api.sweep(id)])[0],
  );

/** Headless runs and campaigns: start them, watch them, read their results. */
export function RunsPage() {
  const [filter, setFilter] = useState(ALL);
  const [wanted] = useDebouncedValue(filter, PAUSE_MS);
  const { value, error, since, again, more } = useList(
    ["jobs", wanted],
    (most) => jobsLike(wanted, most),
    (jobs) => (jobs?.some((job) => job.isActive) ? BUSY_MS : CALM_MS),
  );
  const [chosen, choose] = useChosen();
  const [scenarios, setScenarios] = useState<string[]>([]);
  useEffect(() => {
    api.scenarios().then((found) => setScenarios(found.map((one) => one.id)), showError);
  }, []);
  const isFiltered = Object.values(filter).some(Boolean);
  const listed = value?.find((one) => one.id === chosen?.id);
  const id = chosen?.kind === "comparison" ? undefined : chosen?.id;
  const alone = useAnswer(
    value && id && !listed ? ["job", id] : undefined,
    () => jobOf(id ?? ""),
    (found) => (found?.isActive ? BUSY_MS : undefined),
  );
  const job = listed ?? (alone.value?.id === id ? alone.value : undefined);
  const detail = useRef<HTMLElement>(null);
  // A result below the list scrolls into view when it is chosen.
  useEffect(() => {
    if (chosen?.id) detail.current?.scrollIntoView({ block: "start" });
  }, [chosen?.id]);
  const started = useCallback(
    (next: Parameters<typeof choose>[0]) => {
      choose(next);
      again();
    },
    [choose, again],
  );
  return (
    <div className={`paper ${styles.page}`}>
      <Stack component="section" className="card" gap={12} p={12} aria-label="Start a run">
        <PageHead
          name="Runs"
          item={chosen?.kind === "comparison" ? "Comparison" : job?.title}
          heading="Runs and campaigns"
        />
        <StartForm onStarted={started} />
      </Stack>
      <section className={`card ${styles.jobs}`} aria-label="Runs and campaigns">
        <Stale error={error} since={since} onRetry={again} />
        <JobFilter filter={filter} scenarios={scenarios} onChange={setFilter} />
        {value && value.length > 0 ? (
          <>
            <JobList jobs={value} chosen={chosen} onChoose={choose} onChanged={again} />
            <ShowOlder more={more} />
          </>
        ) : value && isFiltered ? (
          <EmptyState
            title="No run matches"
            action={
              <Button size="xs" onClick={() => setFilter(ALL)}>
                Show all
              </Button>
            }
          >
            Choose another state or scenario, or search for fewer words.
          </EmptyState>
        ) : (
          !error && (
            <EmptyState title={value ? "Nothing has been run yet" : "Asking the server"}>
              Start a run beside this list, or run an experiment from the gallery.
            </EmptyState>
          )
        )}
      </section>
      <section
        ref={detail}
        className={`column card ${styles.detail}`}
        data-chosen={chosen !== undefined}
        aria-label="Result"
      >
        {chosen?.kind === "comparison" ? (
          <RunComparison key={chosen.id} ids={chosen.id} />
        ) : job?.kind === "run" ? (
          <RunDetail key={job.id} run={job.run} onChanged={again} />
        ) : job?.kind === "campaign" ? (
          <CampaignDetail key={job.id} sweep={job.sweep} onChanged={again} />
        ) : (
          <EmptyState title={alone.error ? "There is no such run" : id ? "Asking the server" : "No result chosen"}>
            Choose a run or a campaign from the list: figures, expectations, reports and downloads appear here.
          </EmptyState>
        )}
      </section>
    </div>
  );
}
