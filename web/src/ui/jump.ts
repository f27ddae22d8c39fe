/** Where the time panels should look: a tick of the past, or live. */
export type JumpTarget = { tick: number } | "live";

const listeners = new Set<(target: JumpTarget) => void>();

/** Send every time panel to a tick, or back to the newest data. */
export const jump = {
  to(target: JumpTarget): void {
    for (const listener of listeners) listener(target);
  },
  listen(listener: (target: JumpTarget) => void): () => void {
    listeners.add(listener);
    return () => {
      listeners.delete(listener);
    };
  },
};
