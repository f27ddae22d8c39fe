import { useEffect, useMemo, useState } from "react";
import { useShallow } from "zustand/react/shallow";
import { hasEnded, useSteps } from "../bench/steps";
import { useBench } from "../stream/bench-store";
import { type Hints, hintsOf } from "./hints";

const DISMISSED = "combbench.hint.seen";
const DONE = "combbench.hints.done";

interface TickedHints extends Hints {
  done: ReadonlySet<string>;
  dismiss(): void;
}

const storedDone = () => (localStorage.getItem(DONE) ?? "").split(" ").filter(Boolean);

/** What to try on the bench, ticked off as it is done; nothing once dismissed, all done, or the scenario at its end. */
export function useHints(): TickedHints | undefined {
  const bench = useBench(
    useShallow(({ bench }) => {
      if (!bench) return undefined;
      const { axes, controllers, diagnosers, replay_of, signals } = bench;
      return { axes, controllers, diagnosers, replay_of, signals };
    }),
  );
  const events = useBench((s) => s.events);
  const steps = useSteps();
  const hasSteps = steps.length > 1;
  const ended = useBench(({ bench }) => bench !== undefined && hasSteps && hasEnded(bench, steps));
  const [dismissed, setDismissed] = useState(() => localStorage.getItem(DISMISSED) !== null);
  const [before] = useState(storedDone);
  const hints = useMemo(() => bench && hintsOf(bench, hasSteps), [bench, hasSteps]);
  const now = (hints?.hints ?? []).filter((hint) => before.includes(hint.id) || events.some(hint.isDone));
  const done = now.map((hint) => hint.id).join(" ");
  useEffect(() => {
    localStorage.setItem(DONE, [...new Set([...storedDone(), ...done.split(" ").filter(Boolean)])].join(" "));
  }, [done]);
  // what was found at each step stands in their place then
  if (ended) return undefined;
  if (dismissed || !hints || hints.hints.every((hint) => before.includes(hint.id))) return undefined;
  return {
    ...hints,
    done: new Set(done.split(" ")),
    dismiss: () => {
      localStorage.setItem(DISMISSED, "yes");
      setDismissed(true);
    },
  };
}
