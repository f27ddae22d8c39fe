import { useEffect, useState } from "react";

type Listener = (tick: number | undefined) => void;

const listeners = new Set<Listener>();
let current: number | undefined;

/** The tick under the pointer, shared by every panel; outside React because it moves with every frame. */
export const hover = {
  get tick(): number | undefined {
    return current;
  },
  set(tick: number | undefined): void {
    if (tick === current) return;
    current = tick;
    for (const listener of listeners) listener(tick);
  },
  listen(listener: Listener): () => void {
    listeners.add(listener);
    return () => {
      listeners.delete(listener);
    };
  },
};

const REST_MS = 120;

/** The tick under a resting pointer, so that the server is not asked at every move. */
export function useRestingTick(wanted = true): number | undefined {
  const [rested, setRested] = useState<number | undefined>(undefined);
  useEffect(() => {
    if (!wanted) return;
    let timer: ReturnType<typeof setTimeout> | undefined;
    const stop = hover.listen((tick) => {
      clearTimeout(timer);
      if (tick === undefined) setRested(undefined);
      else timer = setTimeout(() => setRested(Math.floor(tick)), REST_MS);
    });
    return () => {
      stop();
      clearTimeout(timer);
      setRested(undefined);
    };
  }, [wanted]);
  return rested;
}

/** Where the time panels should look: a tick of the past, or live. */
type JumpTarget = { tick: number } | "live";

const jumpers = new Set<(target: JumpTarget) => void>();

/** Send every time panel to a tick, or back to the newest data. */
export const jump = {
  to(target: JumpTarget): void {
    for (const listener of jumpers) listener(target);
  },
  listen(listener: (target: JumpTarget) => void): () => void {
    jumpers.add(listener);
    return () => {
      jumpers.delete(listener);
    };
  },
};
