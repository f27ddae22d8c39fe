import { Box, Button, Stack } from "@mantine/core";
import { IconPlayerTrackNext, IconRepeat } from "@tabler/icons-react";
import { useMemo } from "react";
import { useMay } from "../api/me";
import type { Bench } from "../api/types";
import { actions } from "../bench/actions";
import { diagnoserWords, hypothesisWords } from "../bench/hypothesis-words";
import { type BenchStep, hasEnded, useSteps } from "../bench/steps";
import { conditionWords } from "../panels/condition/condition";
import { type TruthSwitch, truthSwitches } from "../panels/lanes/delays";
import { useBench } from "../stream/bench-store";
import { currentEvents } from "../stream/event-log";
import { staleWords, useBoardState, useStaleSince } from "../stream/freshness";
import { formatIn, formatSi } from "../ui/format";
import rest from "./rest.module.css";
import styles from "./strip.module.css";
import { StripButton } from "./strip-button";

/** The steps of a scenario: which comes next and when, on to it or back. */
export function StepBar() {
  const steps = useSteps();
  const bench = useBench((s) => (steps.length > 1 ? s.bench : undefined));
  const repeats = useRepeats(steps);
  const drives = useDrives();
  if (!bench) return null;
  const next = steps.findIndex((step) => !step.done);
  const now = steps[(next < 0 ? steps.length : next) - 1];
  return (
    <section className={`line ${styles.lead}`} data-of-bench="" aria-label="Steps of the scenario">
      <StepWords bench={bench} steps={steps} />
      {repeats && (
        <StripButton
          icon={<IconRepeat size={16} />}
          label="Replay step"
          title={`Begin the scenario again just before "${now.words}"; what was changed by hand is not kept`}
          onClick={() => actions.replayStep(now.tick)}
        />
      )}
      {drives && (
        <Button
          variant="filled"
          leftSection={<IconPlayerTrackNext size={16} />}
          title="Run as fast as possible to just before the next step"
          disabled={bench.fast_forward !== null || hasEnded(bench, steps) || (next < 0 && !bench.samples)}
          onClick={actions.skip}
        >
          {next < 0 ? "To the end" : "Skip"}
        </Button>
      )}
    </section>
  );
}

/** Whether the person drives a board that is known to run. */
function useDrives(): boolean {
  const mayDrive = useMay("drive");
  return useBoardState() !== undefined && mayDrive;
}

/** Whether a step can begin again: each comes again after a reset. */
const useRepeats = (steps: readonly BenchStep[]): boolean => useDrives() && steps.every((step) => step.ofScenario);

/** Which step of a scenario comes next, or was the last. */
function StepWords({ bench, steps }: { bench: Bench; steps: BenchStep[] }) {
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

interface Scored {
  id: string;
  switches: TruthSwitch[];
}

/** The diagnosers that are compared with the truth, and its changes as each met them. */
export function useScored(): Scored[] {
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const events = useBench((s) => s.events);
  return useMemo(() => {
    const current = currentEvents(events);
    const all = Object.keys(diagnosers ?? {}).map((id) => ({ id, switches: truthSwitches(current, id) }));
    return all.filter(({ switches }) => switches.length > 0);
  }, [events, diagnosers]);
}

/** The findings of each diagnoser at each step; of no diagnoser, the steps alone. A click begins a step again. */
export function Findings({ scored }: { scored: Scored[] }) {
  const steps = useSteps();
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const repeats = useRepeats(steps);
  const several = scored.length > 1;
  return (
    <ol className={rest.findings} aria-label={scored.length > 0 ? "Findings at each step" : "All steps"}>
      {steps.map((step, i) => {
        const end = steps[i + 1]?.done ? (steps[i + 1].tick ?? Infinity) : Infinity;
        const found = scored.flatMap(({ id, switches: all }) => {
          const change = step.done
            ? all.findLast(({ tick }) => tick >= (step.tick ?? Infinity) && tick < end)
            : undefined;
          return change ? [`${several ? `${diagnoserWords(id, diagnosers)} ` : ""}${foundWords(change, dtMs)}`] : [];
        });
        const nothing = scored.length > 0 && step.isFault ? "nothing to find" : "done";
        const words = step.done ? found.join("; ") || nothing : "to come";
        return (
          <Stack component="li" key={`${step.tick} ${step.when}`} gap={0} align="flex-start">
            {repeats && step.done ? (
              <button type="button" title="Replay this step" onClick={() => actions.replayStep(step.tick)}>
                {i + 1} {step.words}
              </button>
            ) : (
              <b>
                {i + 1} {step.words}
              </b>
            )}
            <Box component="span" c="dimmed">
              {words}
            </Box>
          </Stack>
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
