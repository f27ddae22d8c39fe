import { ActionIcon, Button, Checkbox, Group, Progress } from "@mantine/core";
import { IconArrowsDiff, IconPlayerStopFilled, IconTrash } from "@tabler/icons-react";
import { useState } from "react";
import { api } from "../api/api";
import { showError } from "../bench/send";
import { formatCount } from "../ui/format";
import { type Job, stateText } from "./jobs";
import { OwnValues } from "./own-values";
import styles from "./runs.module.css";
import type { Chosen } from "./use-chosen";

interface JobListProps {
  jobs: Job[];
  chosen: Chosen | undefined;
  onChoose(chosen: Chosen | undefined): void;
  onChanged(): void;
}

const MOST_COMPARED = 8;
const keyOf = (job: Job) => `${job.kind} ${job.id}`;

/** Everything that was asked for, newest first; marked ones are compared or removed. */
export function JobList({ jobs, chosen, onChoose, onChanged }: JobListProps) {
  const [marked, setMarked] = useState<ReadonlySet<string>>(new Set());
  const marks = jobs.filter((job) => marked.has(keyOf(job)));
  const finished = marks.filter((job) => job.kind === "run" && job.state === "done");
  const ended = jobs.filter((job) => !job.isActive);
  const removable = marks.length > 0 ? marks.filter((job) => !job.isActive) : ended;

  const cancel = (job: Job) =>
    (job.kind === "run" ? api.cancelRun(job.id) : api.cancelSweep(job.id)).then(onChanged, showError);
  const remove = async () => {
    const what = removable.length === 1 ? removable[0].title : formatCount(removable.length, "run");
    if (!window.confirm(`Remove ${what} with reports and traces for good?`)) return;
    const runs = removable.filter((job) => job.kind === "run").map((job) => job.id);
    const sweeps = removable.filter((job) => job.kind === "campaign").map((job) => job.id);
    try {
      if (runs.length > 0) await api.removeRuns(runs);
      if (sweeps.length > 0) await api.removeSweeps(sweeps);
      setMarked(new Set());
      if (removable.some((job) => chosen?.id.includes(job.id))) onChoose(undefined);
    } catch (error) {
      showError(error);
    }
    onChanged();
  };
  const mark = (job: Job, is: boolean) => {
    const next = new Set(marked);
    if (is) next.add(keyOf(job));
    else next.delete(keyOf(job));
    setMarked(next);
  };

  return (
    <>
      <Group gap={6} p="0 12px 8px" style={{ borderBottom: "1px solid var(--line)" }}>
        <Button
          leftSection={<IconArrowsDiff size={15} />}
          disabled={finished.length < 2 || finished.length > MOST_COMPARED}
          title={`Mark from 2 to ${MOST_COMPARED} finished runs`}
          onClick={() => onChoose({ kind: "comparison", id: finished.map((job) => job.id).join(",") })}
        >
          Compare{finished.length > 1 && ` ${finished.length}`}
        </Button>
        <Button
          leftSection={<IconTrash size={15} />}
          disabled={removable.length === 0}
          title="Removes runs that have ended, with their files; runs under way stay"
          onClick={remove}
        >
          {marks.length > 0 ? `Remove ${removable.length}` : "Remove all finished"}
        </Button>
      </Group>
      <ul className={styles.list}>
        {jobs.map((job) => (
          <li key={keyOf(job)} data-chosen={job.id === chosen?.id}>
            <Checkbox
              aria-label={`Mark ${job.title}, ${job.about}`}
              checked={marked.has(keyOf(job))}
              onChange={(e) => mark(job, e.currentTarget.checked)}
            />
            <button
              type="button"
              className={styles.pick}
              aria-current={job.id === chosen?.id ? "true" : undefined}
              onClick={() => onChoose({ kind: job.kind, id: job.id })}
            >
              <b className="cut">{job.title}</b>
              <span className="cut">{job.about}</span>
              {job.kind === "run" && (
                <span className={`cut ${styles.own}`}>
                  <OwnValues run={job.run} />
                </span>
              )}
              <span
                className={styles.state}
                data-state={job.state}
                data-ok={job.kind === "run" ? job.run.summary?.ok === true : undefined}
              >
                {stateText(job)}
              </span>
              <time dateTime={job.created} title={new Date(job.created).toLocaleString()}>
                {whenText(new Date(job.created))}
              </time>
              {job.state === "running" && (
                <Progress value={job.progress * 100} size="sm" w="100%" aria-label={`Progress of ${job.title}`} />
              )}
            </button>
            {job.isActive && (
              <ActionIcon
                size={28}
                color="alarm"
                aria-label={`Cancel ${job.title}`}
                title={
                  job.kind === "run" ? "Cancel" : "Stop; finished runs are kept, and the campaign can continue later"
                }
                onClick={() => cancel(job)}
              >
                <IconPlayerStopFilled size={15} />
              </ActionIcon>
            )}
          </li>
        ))}
      </ul>
    </>
  );
}

/** The time of day, or the date of another day. */
const whenText = (moment: Date) =>
  moment.toDateString() === new Date().toDateString()
    ? moment.toLocaleTimeString([], { timeStyle: "short" })
    : moment.toLocaleDateString([], { dateStyle: "short" });
