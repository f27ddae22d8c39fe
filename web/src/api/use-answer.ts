import { useCallback, useEffect, useRef, useState } from "react";
import { ApiError } from "./api-error";
import { usePageVisible } from "./use-page-visible";

export interface Answer<T> {
  value: T | undefined;
  /** Why the newest question got no answer; what is shown is older then. */
  error: ApiError | undefined;
  /** When `value` came. */
  since: Date | undefined;
  /** Ask now. */
  again(): void;
}

/**
 * What the server answers to a question, asked again every so often while the page is in sight.
 *
 * @param ask The question; a new one (by identity) is asked at once and forgets the answer to the old one.
 * @param every Milliseconds until it is asked again, given the answer; undefined: not again.
 */
export function useAnswer<T>(ask: () => Promise<T>, every: (value: T | undefined) => number | undefined): Answer<T> {
  const visible = usePageVisible();
  const [state, setState] = useState<Omit<Answer<T>, "again"> & { to?: () => Promise<T> }>({
    value: undefined,
    error: undefined,
    since: undefined,
  });
  const [round, setRound] = useState(0);
  const pace = useRef(every);
  pace.current = every;

  // biome-ignore lint/correctness/useExhaustiveDependencies: a new round asks the same question again
  useEffect(() => {
    if (!visible) return;
    let timer: ReturnType<typeof setTimeout> | undefined;
    let gone = false;
    const go = async () => {
      let value: T | undefined;
      try {
        value = await ask();
        if (!gone) setState({ value, error: undefined, since: new Date(), to: ask });
      } catch (error) {
        if (!(error instanceof ApiError)) throw error;
        if (!gone)
          setState((s) => ({ ...(s.to === ask ? s : { value: undefined, since: undefined }), error, to: ask }));
      }
      const wait = pace.current(value);
      if (!gone && wait !== undefined) timer = setTimeout(go, wait);
    };
    void go();
    return () => {
      gone = true;
      clearTimeout(timer);
    };
  }, [ask, visible, round]);

  const again = useCallback(() => setRound((n) => n + 1), []);
  const fits = state.to === ask;
  return { value: fits ? state.value : undefined, error: fits ? state.error : undefined, since: state.since, again };
}
