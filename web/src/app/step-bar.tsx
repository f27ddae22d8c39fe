import { Button } from "@mantine/core";
import { IconListCheck, IconPlayerTrackNext, IconRepeat } from "@tabler/icons-react";
import { useMemo, useState } from "react";
import { useMay } from "../api/me";
import type { Bench } from "../api/types";
import { actions } from "../bench/actions";
import { hypothesisWords } from "../bench/hypothesis-words";
import { type BenchStep, hasEnded, useSteps } from "../bench/steps";
import { conditionWords } from "../panels/condition/condition";
import { type TruthSwitch, truthSwitches } from "../panels/lanes/delays";
import { useBench } from "../stream/bench-store";
import { currentEvents } from "../stream/event-log";
import { staleWords, useBoardState, useStaleSince } from "../stream/freshness";
import { formatIn, formatSi } from "../ui/format";
import styles from "./step-bar.module.css";

/** The steps of a scenario: which comes next and when, on to it or back, and in the end what was found at each. */
export function StepBar() {
  const steps = useSteps();
  const bench = useBench((s) => (steps.length > 1 ? s.bench : undefined));
  return bench ? <Bar key={bench.id} bench={bench} steps={steps} /> : null;
}

/** Which step of a scenario comes next, or was the last. */
export function StepWords({ bench, steps }: { bench: Bench; steps: BenchStep[] }) {
  const next = steps.findIndex((step) => !step.done);
  const shown = next < 0 ? steps.length - 1 : next;
  const { words, tick, when } = steps[shown];
  const left = next >= 0 ? tick : (bench.samples ?? undefined);
  const stale = useStaleSince();
  const wait = stale
    ? staleWords(stale)
    : when
      ? `when ${conditionWords(when, bench.signals)}`
      : waitWords(bench, left, next < 0);
  return (
    <p className={styles.words}>
      <strong>
        {shown + 1} of {steps.length}: {words}
      </strong>
      {wait && <span>, {wait}</span>}
    </p>
  );
}

function Bar({ bench, steps }: { bench: Bench; steps: BenchStep[] }) {
  const next = steps.findIndex((step) => !step.done);
  const now = steps[(next < 0 ? steps.length : next) - 1];
  const ended = hasEnded(bench, steps);
  const scored = useScored(bench);
  const [asked, setAsked] = useState<boolean | undefined>(undefined);
  const open = asked ?? (ended && scored.length > 0);
  const mayDrive = useMay("drive");
  const drives = useBoardState() !== undefined && mayDrive;
  const repeats = drives && steps.every((step) => step.ofScenario);
  return (
    <section className={styles.bar} data-of-bench="" aria-label="Steps of the scenario">
      <StepWords bench={bench} steps={steps} />
      <div className={styles.actions}>
        <Button
          size="compact-sm"
          variant="subtle"
          leftSection={<IconListCheck size={16} />}
          aria-expanded={open}
          onClick={() => setAsked(!open)}
        >
          {scored.length > 0 ? "What was found" : "All steps"}
        </Button>
        {repeats && (
          <Button
            size="compact-sm"
            variant="default"
            leftSection={<IconRepeat size={16} />}
            title={`Begin the scenario again just before "${now.words}"; what was changed by hand is not kept`}
            onClick={() => actions.replayStep(now.tick)}
          >
            Replay step
          </Button>
        )}
        {drives && (
          <Button
            size="compact-sm"
            leftSection={<IconPlayerTrackNext size={16} />}
            title="Run as fast as possible to just before the next step"
            disabled={bench.fast_forward !== null || ended || (next < 0 && !bench.samples)}
            onClick={actions.skip}
          >
            {next < 0 ? "To the end" : "Skip"}
          </Button>
        )}
      </div>
      {open && <Findings bench={bench} steps={steps} repeats={repeats} scored={scored} />}
    </section>
  );
}

interface Scored {
  id: string;
  switches: TruthSwitch[];
}

/** The diagnosers that are compared with the truth, and its changes as each met them. */
function useScored({ diagnosers }: Bench): Scored[] {
  const events = useBench((s) => s.events);
  return useMemo(() => {
    const current = currentEvents(events);
    const all = Object.keys(diagnosers).map((id) => ({ id, switches: truthSwitches(current, id) }));
    return all.filter(({ switches }) => switches.length > 0);
  }, [events, diagnosers]);
}

interface FindingsProps {
  bench: Bench;
  steps: BenchStep[];
  repeats: boolean;
  scored: Scored[];
}

/** The findings of each diagnoser at each step; of no diagnoser, the steps alone. A click begins a step again. */
function Findings({ bench, steps, repeats, scored }: FindingsProps) {
  const several = scored.length > 1;
  const nothing = scored.length > 0 ? "nothing to find" : "done";
  return (
    <ol className={styles.findings} aria-label={scored.length > 0 ? "What was found at each step" : "All steps"}>
      {steps.map((step, i) => {
        const end = steps[i + 1]?.done ? (steps[i + 1].tick ?? Infinity) : Infinity;
        const found = scored.flatMap(({ id, switches: all }) => {
          const change = step.done
            ? all.findLast(({ tick }) => tick >= (step.tick ?? Infinity) && tick < end)
            : undefined;
          return change ? [`${several ? `${id.replaceAll("_", " ")} ` : ""}${foundWords(change, bench.dt_ms)}`] : [];
        });
        const words = step.done ? found.join("; ") || nothing : "to come";
        return (
          <li key={`${step.tick} ${step.when}`}>
            {repeats && step.done ? (
              <button type="button" title="Replay this step" onClick={() => actions.replayStep(step.tick)}>
                {i + 1} {step.words}
              </button>
            ) : (
              <b>
                {i + 1} {step.words}
              </b>
            )}
            <span>{words}</span>
          </li>
        );
      })}
    </ol>
  );
}

function foundWords({ label, delay, findable }: TruthSwitch, dtMs: number): string {
  if (!findable) return "not among the hypotheses";
  if (delay === undefined) return `${hypothesisWords(label)} not found`;
  if (delay === 0) return `said ${hypothesisWords(label)} before`;
  return `found ${hypothesisWords(label)} after ${formatSi(delay * dtMs, "ms", 3)}`;
}

/** When a tick comes, in wall time at the pace that is set. */
function waitWords(bench: Bench, tick: number | undefined, toTheEnd: boolean): string {
  if (tick === undefined) return "";
  const ms = (tick - bench.tick) * bench.dt_ms;
  if (ms <= 0) return toTheEnd ? "ended" : "now";
  const verb = toTheEnd ? "ends in " : "in ";
  if (bench.time_scale === null) return `${verb}${formatSi(ms, "ms", 3)} of device time`;
  const seconds = ms / 1000 / bench.time_scale;
  return verb + (seconds < 100 ? formatIn(Math.ceil(seconds), "s", 0) : formatIn(Math.ceil(seconds / 60), "min", 0));
}
