import { useEffect, useMemo, useState } from "react";
import { useShallow } from "zustand/react/shallow";
import { storageName } from "../api/storage-name";
import { useBench } from "../stream/bench-store";
import { type Hints, hintsOf } from "./hints";

const DISMISSED = storageName("combbench.hint.seen");
const DONE = storageName("combbench.hints.done");

export interface TickedHints extends Hints {
  done: ReadonlySet<string>;
  dismiss(): void;
}

const storedDone = () => (localStorage.getItem(DONE) ?? "").split(" ").filter(Boolean);

/** What to try on the bench, ticked off as it is done; nothing once dismissed, or where all was done at a visit before. */
export function useHints(): TickedHints | undefined {
  const bench = useBench(
    useShallow(({ bench }) => {
      if (!bench) return undefined;
      const { axes, controllers, diagnosers, record, replay_of, signals } = bench;
      return { axes, controllers, diagnosers, record, replay_of, signals };
    }),
  );
  const events = useBench((s) => s.events);
  const [dismissed, setDismissed] = useState(() => localStorage.getItem(DISMISSED) !== null);
  const [before] = useState(storedDone);
  const hints = useMemo(() => bench && hintsOf(bench), [bench]);
  const now = (hints?.hints ?? []).filter((hint) => before.includes(hint.id) || events.some(hint.isDone));
  const done = now.map((hint) => hint.id).join(" ");
  useEffect(() => {
    localStorage.setItem(DONE, [...new Set([...storedDone(), ...done.split(" ").filter(Boolean)])].join(" "));
  }, [done]);
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
