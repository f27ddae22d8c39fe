import { type BenchStore, useBench } from "../stream/bench-store";

/** Wait until the state of the bench on the page meets a condition, or for the longest time. */
export function untilBench(isMet: (state: BenchStore) => boolean, mostMs: number): Promise<void> {
  return new Promise((resolve) => {
    const settle = (state: BenchStore) => {
      if (isMet(state)) done();
    };
    const stop = useBench.subscribe(settle);
    const timer = setTimeout(done, mostMs);
    function done() {
      clearTimeout(timer);
      stop();
      resolve();
    }
    settle(useBench.getState());
  });
}
