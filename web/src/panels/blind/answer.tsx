import { Button, Radio } from "@mantine/core";
import { type ReactNode, useMemo, useState } from "react";
import { blind } from "../../api/blind";
import type { Question } from "../../api/types";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { showError } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import exercise from "../../ui/exercise.module.css";
import { formatPercent, formatSi } from "../../ui/format";
import { Slider } from "../../ui/slider";
import styles from "./blind.module.css";

interface AnswerProps {
  question: Question;
  /** How points are counted. */
  rule: ReactNode;
  onEnded(): void;
}

/** The question: what the device is now, and how sure that is. */
export function Answer({ question, rule, onEnded }: AnswerProps) {
  const { answers, factors, by_tick } = question;
  const bench = useBench((s) => s.bench?.id) ?? "";
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const hasCome = useBench((s) => (s.bench?.tick ?? 0) >= by_tick);
  const [said, setSaid] = useState<string | undefined>(undefined);
  const [confidence, setConfidence] = useState(70);
  const [busy, setBusy] = useState(false);
  const known = useMemo(() => ({ answers: { kind: "", names: answers, factors } }), [answers, factors]);
  const end = (ended: Promise<unknown>) => {
    setBusy(true);
    void ended.then(onEnded, showError).finally(() => setBusy(false));
  };
  return (
    <>
      <div className={`column ${styles.question}`}>
        <p className={exercise.text}>
          {hasCome
            ? "If there is a fault, it has come."
            : `If there is a fault, it comes before ${formatSi(by_tick * dtMs, "ms", 3)}.`}
        </p>
        <Radio.Group label="What is hidden here?" value={said ?? ""} onChange={setSaid}>
          <div className={styles.answers}>
            {answers.map((name) => (
              <Radio key={name} value={name} label={hypothesisWords(name, known)} />
            ))}
          </div>
        </Radio.Group>
        <p className={exercise.text}>You may change the reference and the controller meanwhile.</p>
        {rule}
      </div>
      <footer className={`row ${styles.commit}`}>
        <label htmlFor="confidence">
          How sure are you? <strong>{formatPercent(confidence / 100, 0)}</strong>
        </label>
        <Slider
          id="confidence"
          className={styles.slider}
          thumbLabel="How sure are you, percent"
          min={Math.ceil(100 / answers.length)}
          max={100}
          label={null}
          value={confidence}
          onChange={setConfidence}
        />
        <Button
          variant="filled"
          size="xs"
          loading={busy}
          disabled={said === undefined}
          onClick={() => said && end(blind.answer(bench, said, confidence / 100))}
        >
          Commit the answer
        </Button>
        <Button size="xs" variant="subtle" disabled={busy} onClick={() => end(blind.giveUp(bench))}>
          Give up
        </Button>
      </footer>
    </>
  );
}
