import { Box, Button, Radio, SimpleGrid, Stack } from "@mantine/core";
import { type ReactNode, useMemo, useState } from "react";
import { blind } from "../../api/blind";
import type { Question } from "../../api/types";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { useBusy } from "../../bench/use-busy";
import { useBench } from "../../stream/bench-store";
import exercise from "../../ui/exercise.module.css";
import { formatPercent, formatSi } from "../../ui/format";
import { Slider } from "../../ui/slider";

const COMMIT = { gap: "6px 12px", borderTop: "1px solid var(--line)" };

interface AnswerProps {
  question: Question;
  /** The rule for points. */
  rule: ReactNode;
  onEnded(): void;
}

/** The question: the state of the device now, and a confidence. */
export function Answer({ question, rule, onEnded }: AnswerProps) {
  const { answers, factors, by_tick } = question;
  const bench = useBench((s) => s.bench?.id) ?? "";
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const hasCome = useBench((s) => (s.bench?.tick ?? 0) >= by_tick);
  const [said, setSaid] = useState<string | undefined>(undefined);
  const [confidence, setConfidence] = useState(70);
  const [busy, during] = useBusy();
  const known = useMemo(() => ({ answers: { kind: "", names: answers, factors } }), [answers, factors]);
  const end = (ended: () => Promise<unknown>) => void during(() => ended().then(onEnded));
  return (
    <>
      <Stack gap={8} flex={1} p="8px 12px" style={{ overflowY: "auto" }} data-testid="question">
        <p className={exercise.text}>
          {hasCome
            ? "If there is a fault, it has come."
            : `If there is a fault, it comes before ${formatSi(by_tick * dtMs, "ms", 3)}.`}
        </p>
        <Radio.Group label="What is hidden here?" value={said ?? ""} onChange={setSaid}>
          <SimpleGrid cols={2} spacing={12} verticalSpacing={6} pt={6}>
            {answers.map((name) => (
              <Radio key={name} value={name} label={hypothesisWords(name, known)} />
            ))}
          </SimpleGrid>
        </Radio.Group>
        <p className={exercise.text}>You may change the reference and the controller meanwhile.</p>
        {rule}
      </Stack>
      <Box component="footer" className="row" flex="none" p="8px 12px" fz="sm" style={COMMIT}>
        <label htmlFor="confidence">
          How sure are you? <strong>{formatPercent(confidence / 100, 0)}</strong>
        </label>
        <Slider
          id="confidence"
          flex="1 1 120px"
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
          onClick={() => said && end(() => blind.answer(bench, said, confidence / 100))}
        >
          Commit the answer
        </Button>
        <Button size="xs" variant="subtle" disabled={busy} onClick={() => end(() => blind.giveUp(bench))}>
          Give up
        </Button>
      </Box>
    </>
  );
}
