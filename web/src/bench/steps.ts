import { useMemo } from "react";
import type { Bench, Command, LogEntry } from "../api/types";
import { useCatalog } from "../api/use-catalog";
import { useBench } from "../stream/bench-store";
import { currentEvents } from "../stream/event-log";
import { flagWords, titleOf } from "./flag-words";

/** The commands to a bench at one moment of its scenario. */
export interface BenchStep {
  words: string;
  /** Where it took effect, or will; unknown while a condition is awaited. */
  tick: number | undefined;
  /** The condition that is awaited. */
  when: string | undefined;
  done: boolean;
  /** A fault begins or ends, which diagnosers are to notice. */
  isFault: boolean;
  /** It is of the scenario, so that it comes again after a reset. */
  ofScenario: boolean;
}

interface Act {
  command: Command;
  actor: string;
  tick: number | undefined;
  when: string | undefined;
  done: boolean;
}

const SCENARIO = "scenario";
const START: BenchStep = { words: "start", tick: 0, when: undefined, done: true, isFault: false, ofScenario: true };

const NONE: never[] = [];

/** The steps of the bench on the page; none while it plays a recording or hides a fault. */
export function useSteps(): BenchStep[] {
  const events = useBench((s) => s.events);
  const pending = useBench((s) => s.bench?.pending);
  const shown = useBench((s) => !s.blind && s.bench?.replay_of === null);
  // the words of a step come from the catalogue
  const known = useCatalog().blocks.length > 0;
  return useMemo(
    () => (known && shown && pending ? stepsOf(currentEvents(events), pending) : NONE),
    [known, events, pending, shown],
  );
}

/** Whether the last step was taken and the scenario is over. */
export const hasEnded = (bench: Pick<Bench, "samples" | "tick">, steps: readonly BenchStep[]): boolean =>
  steps.every(({ done }) => done) && (!bench.samples || bench.tick >= bench.samples);

/** The longest time between two steps, in ticks; from a single one, that to the end. Undefined where it is not known. */
export function longestStep(steps: readonly BenchStep[], end: number | null | undefined): number | undefined {
  const ticks = steps.slice(1).flatMap(({ tick }) => tick ?? []);
  const edges = ticks.length === 1 && end ? [...ticks, end] : ticks;
  const gaps = edges.map((tick, i) => tick - (edges[i - 1] ?? tick));
  const longest = Math.max(0, ...gaps);
  return longest > 0 ? longest : undefined;
}

/** The steps of a bench, its start first; none where no command waits and the scenario has given none. */
export function stepsOf(events: readonly LogEntry[], pending: Bench["pending"]): BenchStep[] {
  const planned = new Set(events.filter((e) => e.kind === "scheduled").map(planOf));
  const acts: Act[] = [];
  for (const event of events) {
    const { command, kind, actor, tick } = event;
    if (!command || "kind" in command || kind === "scheduled" || kind === "refused" || tick === 0) continue;
    if (actor === SCENARIO || planned.has(planOf(event)))
      acts.push({ command, actor, tick, when: undefined, done: true });
  }
  for (const { command, actor, tick, when } of pending)
    acts.push({
      command: command as Command,
      actor,
      tick: when ? undefined : (tick ?? undefined),
      when: when ?? undefined,
      done: false,
    });
  if (!acts.some(({ done, actor }) => !done || actor === SCENARIO)) return [];
  const moments = new Map<string, Act[]>();
  for (const act of acts) {
    const moment = act.when ?? String(act.tick);
    moments.set(moment, [...(moments.get(moment) ?? []), act]);
  }
  return [START, ...[...moments.values()].map(stepOf)];
}

function stepOf(acts: Act[]): BenchStep {
  const [{ tick, when, done }] = acts;
  const healed = acts.flatMap(({ command }) => ("heal" in command ? healedBy(command) : []));
  const others = acts.filter(({ command }) => !("heal" in command));
  const words = (others.length > 0 ? others : acts).map(({ command }) => wordsOf(command)).join(", ");
  const replaces = healed.length > 0 && others.some(({ command }) => "fault" in command);
  return {
    words: replaces ? `${healed.join(", ")} removed, ${words.charAt(0).toLowerCase()}${words.slice(1)}` : words,
    tick,
    when,
    done,
    isFault: acts.some(({ command }) => "fault" in command || "heal" in command),
    ofScenario: acts.every(({ actor }) => actor === SCENARIO),
  };
}

/** The faults that a command heals, by their titles. */
const healedBy = ({ heal }: Extract<Command, { heal: unknown }>): string[] =>
  heal === "all" ? ["All faults"] : (heal as string[]).map((name) => titleOf("faults", name));

const wordsOf = (command: Command) =>
  flagWords({ kind: "heal" in command ? "heal" : "", command } as unknown as LogEntry);

/** A command and who gave it, whatever its moment. */
const planOf = ({ actor, command }: Pick<LogEntry, "actor" | "command">): string =>
  JSON.stringify([actor, { ...command, at_sample: undefined, at_ms: undefined, when: undefined }]);
