import { Box } from "@mantine/core";
import { useEffect, useRef } from "react";
import { showSentence, useNarrator, useSaid, useVoting } from "../../bench/narrator";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatCount } from "../../ui/format";
import { CopyMenu } from "../events/copy-menu";
import styles from "../events/events.module.css";

const SHOWN = 300;
const TONES: Record<string, string> = {
  trip: "alarm",
  fault: "alarm",
  verdict: "found",
  settled: "found",
  false_verdict: "doubt",
};

/** A menu to copy the command of a sentence; empty for an event of the bench itself. */
function CopySentence({ tick }: { tick: number }) {
  const event = useBench((s) => s.events.findLast((one) => one.tick === tick && one.command));
  return event && <CopyMenu event={event} />;
}

/** Events in sentences, newest last; a click takes the scopes there. A replay lists later sentences as well. */
export function NarratorPanel() {
  const { before, sentences } = useBench((s) => s.narration);
  const said = useSaid();
  const voting = useVoting();
  const chosen = useNarrator((s) => s.chosen);
  const list = useRef<HTMLOListElement>(null);
  useEffect(() => {
    list.current?.children[Math.max(0, said - 1)]?.scrollIntoView({ block: "nearest" });
  }, [said]);
  if (voting)
    return (
      <EmptyState title="Not while a vote is open">
        Events would reveal the answer. They are listed here afterwards.
      </EmptyState>
    );
  if (sentences.length === 0)
    return (
      <EmptyState title="No events yet">
        Each fault, switch, verdict and trip is described here with its numbers. Inject a fault to see the first.
      </EmptyState>
    );
  const first = Math.max(0, sentences.length - SHOWN);
  return (
    <ol ref={list} className={styles.list} aria-label="Sentences of the narrator, newest last">
      {before + first > 0 && (
        <Box component="li" className="note" p="3px 12px">
          Earlier: {formatCount(before + first, "sentence")}
        </Box>
      )}
      {sentences.slice(first).map((sentence, at) => (
        <Box component="li" className="line" pr={6} key={`${sentence.tick} ${sentence.text}`}>
          <button
            type="button"
            className={styles.entry}
            data-tone={TONES[sentence.kind]}
            data-chosen={sentence === chosen}
            data-ahead={first + at >= said}
            aria-current={first + at === said - 1 ? "step" : undefined}
            onClick={() => showSentence(sentence)}
            title={`Tick ${sentence.tick}: show it on the scopes`}
          >
            {sentence.text}
          </button>
          {sentence.tick === sentence.span[0] && <CopySentence tick={sentence.tick} />}
        </Box>
      ))}
    </ol>
  );
}
