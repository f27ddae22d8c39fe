import { useEffect, useState } from "react";
import { api } from "../../api/api";
import { ApiError } from "../../api/api-error";
import type { Account } from "../../api/types";

interface Answer {
  account: Account | undefined;
  refusal: ApiError | undefined;
  /** The account shown belongs to the sample before. */
  waiting: boolean;
}

/** What the bench says about one sample; the last answer stays while the next is on its way. */
export function useExplanation(bench: string | undefined, sample: { diagnoser: string; tick: number } | undefined) {
  const [answer, setAnswer] = useState<Answer>({ account: undefined, refusal: undefined, waiting: false });
  const diagnoser = sample?.diagnoser;
  const tick = sample?.tick;
  useEffect(() => {
    if (!bench || diagnoser === undefined || tick === undefined) return;
    let current = true;
    setAnswer((last) => ({ ...last, waiting: true }));
    api.explanation(bench, diagnoser, tick).then(
      (account) => current && setAnswer({ account, refusal: undefined, waiting: false }),
      (error: unknown) => {
        if (!(error instanceof ApiError)) throw error;
        if (current) setAnswer({ account: undefined, refusal: error, waiting: false });
      },
    );
    return () => {
      current = false;
    };
  }, [bench, diagnoser, tick]);
  return answer;
}
