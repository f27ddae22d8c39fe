type Listener = (tick: number | undefined, source: object | undefined) => void;

const listeners = new Set<Listener>();
let current: number | undefined;

/** The tick under the pointer, shared by every panel; outside React because it moves with every frame. */
export const hover = {
  get tick(): number | undefined {
    return current;
  },
  set(tick: number | undefined, source: object): void {
    if (tick === current) return;
    current = tick;
    for (const listener of listeners) listener(tick, source);
  },
  listen(listener: Listener): () => void {
    listeners.add(listener);
    return () => {
      listeners.delete(listener);
    };
  },
};

/** Where the time panels should look: a tick of the past, or live. */
export type JumpTarget = { tick: number } | "live";

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
