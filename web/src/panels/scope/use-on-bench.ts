import { useMemo } from "react";
import { useShallow } from "zustand/react/shallow";
import { type Driven, drivenBy } from "../../bench/driven";
import { useBench } from "../../stream/bench-store";
import { currentEvents } from "../../stream/event-log";
import { namedFor, onBench, type ScopeConfig } from "../../stream/scope-config";

/** When the controller of a signal drove, for signals that are shown for that time alone. */
export type Drives = Partial<Record<string, Driven[]>>;

/** A scope as it is on the bench, and the times for which controllers drove, by signal. */
export function useOnBench(kept: ScopeConfig): { config: ScopeConfig; drives: Drives } {
  const signals = useBench((s) => s.bench?.signals);
  const controller = useBench((s) => s.bench?.controller ?? "");
  const switches = useBench(useShallow((s) => currentEvents(s.events).filter(({ kind }) => kind === "switch")));
  return useMemo(() => {
    const driven = drivenBy(controller, switches);
    const controllers = driven.map(({ name }) => name);
    const drives: Drives = {};
    for (const signal of kept.signals)
      for (const span of driven) {
        const [name] = namedFor(signal, [span.name]);
        if (name !== signal) drives[name] = [...(drives[name] ?? []), span];
      }
    return { config: onBench(kept, signals ?? [], controllers), drives };
  }, [kept, signals, controller, switches]);
}
