import { useMemo } from "react";
import { useMe } from "../../api/me";
import { useVote } from "../../bench/vote";

/** Votes for the lane of each hypothesis. */
export interface Votes {
  counts: number[];
  atMs: number[][];
}

/** Predictions for the lanes of a diagnoser, once they are revealed. */
export function useRevealed(id: string, names: readonly string[]): Votes | undefined {
  const asked = useVote((s) => s.vote);
  const mine = useMe((s) => s.me?.vote);
  const vote = asked ?? mine;
  return useMemo(() => {
    if (!vote?.results || vote.question.diagnoser !== id) return undefined;
    const { results, question } = vote;
    const found = names.map((name) => results[question.answers.indexOf(name)]);
    return { counts: found.map((one) => one?.count ?? 0), atMs: found.map((one) => one?.at_ms ?? []) };
  }, [vote, id, names]);
}
