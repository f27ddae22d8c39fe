import { useEffect, useRef, useState } from "react";
import type { Sentence } from "../api/types";
import { useSaid, useVoting } from "../bench/narrator";
import { useBench } from "../stream/bench-store";
import { formatCount } from "../ui/format";

/** The least time of a sentence on the page, to be read or spoken. */
const LEAST_MS = 2000;

interface CaptionShown {
  sentence: Sentence;
  /** Sentences that came and went since the one shown before. */
  more: number;
}

export const moreText = (count: number) => `Earlier: ${formatCount(count, "sentence")}.`;

/** The newest sentence, a new one at most every two seconds; none while a vote asks what happens. */
export function useCaption(): CaptionShown | undefined {
  const { before, sentences } = useBench((s) => s.narration);
  const said = useSaid();
  const voting = useVoting();
  const newest = said > 0 ? sentences[said - 1] : undefined;
  const number = before + said;
  const [shown, setShown] = useState<(CaptionShown & { number: number }) | undefined>(undefined);
  const since = useRef(-LEAST_MS);
  useEffect(() => {
    if (!newest) return setShown(undefined);
    const show = () => {
      since.current = performance.now();
      setShown((old) => {
        if (old?.sentence === newest) return old;
        const passed = old && old.number < number ? number - old.number - 1 : 0;
        return { sentence: newest, number, more: passed };
      });
    };
    const left = since.current + LEAST_MS - performance.now();
    if (left <= 0) return show();
    const timer = setTimeout(show, left);
    return () => clearTimeout(timer);
  }, [newest, number]);
  return voting || !newest ? undefined : shown;
}
