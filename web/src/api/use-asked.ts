import { useEffect, useRef, useState } from "react";
import { ApiError } from "./api-error";

interface Asked<T> {
  answer: T | undefined;
  refusal: ApiError | undefined;
  /** The answer shown is to the question before. */
  waiting: boolean;
}

/**
 * The server's answer to a question that changes; the last answer stays while the next is on its way.
 *
 * A question is known by its text; undefined asks nothing.
 */
export function useAsked<T>(question: string | undefined, ask: () => Promise<T>): Asked<T> {
  const [asked, setAsked] = useState<Asked<T>>({ answer: undefined, refusal: undefined, waiting: false });
  const call = useRef(ask);
  call.current = ask;
  useEffect(() => {
    if (question === undefined) return;
    let current = true;
    setAsked((last) => ({ ...last, waiting: true }));
    call.current().then(
      (answer) => current && setAsked({ answer, refusal: undefined, waiting: false }),
      (error: unknown) => {
        if (!(error instanceof ApiError)) throw error;
        if (current) setAsked((last) => ({ answer: last.answer, refusal: error, waiting: false }));
      },
    );
    return () => {
      current = false;
    };
  }, [question]);
  return asked;
}
