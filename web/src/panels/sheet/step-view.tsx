import { Box, Button, Group, Radio, Stack, TextInput } from "@mantine/core";
import { type FormEvent, type ReactNode, useState } from "react";
import { ApiError } from "../../api/client";
import type { SheetStep } from "../../api/types";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { useBench } from "../../stream/bench-store";
import { formatCount, formatShort } from "../../ui/format";
import { unitText } from "../../ui/unit-scale";
import styles from "./sheet.module.css";

export interface StepActions {
  answer(step: string, answer: string): Promise<unknown>;
  hide(step: string): void;
  hint(step: string): void;
  close(step: string): void;
}

interface StepProps {
  step: SheetStep;
  isOpen: boolean;
  actions: StepActions;
}

/** A step of a sheet: its conditions, its answers, hints, and the rule for points. */
export function StepView({ step, isOpen, actions }: StepProps) {
  const isHiding = useBench((s) => Boolean(s.bench?.blind));
  const { id, rule, earned, points, hints = [], next_hint_costs: hintCosts, answers = [] } = step;
  return (
    <div className={styles.step} data-open={isOpen}>
      {step.question && (
        <Box component="p" fw={560}>
          {step.question}
        </Box>
      )}
      {(step.conditions ?? []).length > 0 && <Conditions step={step} isOpen={isOpen} />}
      {answers.length > 0 && (
        <Box component="ul" mb={6} aria-label="Answers">
          {answers.map((given, i) => (
            // biome-ignore lint/suspicious/noArrayIndexKey: answers are only ever added
            <li key={i}>
              <b>{given.text}</b>
              {given.reason === null ? " – committed; judged after the run" : ` – ${given.reason}`}
              {given.points !== null && (
                <Box component="span" ml={6} fw={600}>
                  {signed(given.points)}
                </Box>
              )}
            </li>
          ))}
        </Box>
      )}
      {isOpen && step.kind !== "hold" && step.kind !== "blind" && (
        <AnswerForm key={answers.length} step={step} actions={actions} />
      )}
      {hints.map((hint) => (
        <Aside key={hint}>Hint: {hint}</Aside>
      ))}
      {step.solution && !isOpen && <Aside>Right answer: {step.solution}</Aside>}
      {step.given_up && <p className="note">Closed as it was.</p>}
      <p className="note">
        {!isOpen && earned !== null && (
          <Box component="b" c="var(--text)">
            {pointsOf(earned, points)}{" "}
          </Box>
        )}
        {rule}
        {isOpen &&
          step.tries_left != null &&
          step.kind === "question" &&
          ` ${formatCount(step.tries_left, "attempt")} left.`}
      </p>
      {isOpen && (
        <Group gap={8}>
          {step.kind === "blind" && !isHiding && (
            <Button variant="filled" onClick={() => actions.hide(id)}>
              Hide a fault
            </Button>
          )}
          {hintCosts != null && (
            <Button onClick={() => actions.hint(id)}>
              {hintCosts > 0 ? `Hint, costs ${formatShort(hintCosts, "")}` : "Hint, free"}
            </Button>
          )}
          {step.can_go_on && (
            <Button variant="subtle" onClick={() => actions.close(id)}>
              Skip this question
            </Button>
          )}
        </Group>
      )}
    </div>
  );
}

function Aside({ children }: { children: ReactNode }) {
  return (
    <Box component="p" pl={8} style={{ borderLeft: "2px solid var(--paused)" }}>
      {children}
    </Box>
  );
}

const HELD = { flex: 1, maxWidth: 180, accentColor: "var(--accent)" };

/** The quantities with their ranges, ticks where they hold, and the time for which they have held. */
function Conditions({ step, isOpen }: { step: SheetStep; isOpen: boolean }) {
  return (
    <>
      <Box component="ul" className="column" mb={6} style={{ gap: 4 }} aria-label="Conditions">
        {(step.conditions ?? []).map(({ label, now, wanted, holds }) => (
          <Box component="li" key={label} display="flex" style={{ gap: 8 }}>
            <Box component="span" c={holds ? "var(--running)" : undefined} aria-hidden="true">
              {holds ? "✓" : "○"}
            </Box>
            <span>
              {label}
              {now && (
                <>
                  : <b>{hypothesisWords(now)}</b>
                </>
              )}
              {wanted && ` (wanted: ${hypothesisWords(wanted)})`}
              <span className="visually-hidden">{holds ? ", holds" : ", does not hold yet"}</span>
            </span>
          </Box>
        ))}
      </Box>
      {isOpen && (
        <Group gap={8} wrap="nowrap" mb={6} className="note">
          <progress style={HELD} aria-label="Held" max={1} value={step.held_share} />
          <span>{step.held}</span>
        </Group>
      )}
    </>
  );
}

function AnswerForm({ step, actions }: { step: SheetStep; actions: StepActions }) {
  const [text, setText] = useState("");
  const [busy, setBusy] = useState(false);
  const [wrong, setWrong] = useState("");
  const options = Object.entries(step.options ?? {});
  const take = async (event: FormEvent) => {
    event.preventDefault();
    setBusy(true);
    setWrong("");
    try {
      await actions.answer(step.id, text);
    } catch (error) {
      setWrong(error instanceof ApiError ? unread(error) : String(error));
    } finally {
      setBusy(false);
    }
  };
  const says = step.kind === "prediction" ? "Commit the prediction" : "Answer";
  const unit = unitText(step.unit ?? "");
  return (
    <Box
      component="form"
      className="column"
      mb={8}
      style={{ gap: 8 }}
      onSubmit={(event: FormEvent) => void take(event)}
    >
      {options.length > 0 ? (
        <Radio.Group
          label={step.question}
          labelProps={{ className: "visually-hidden" }}
          value={text}
          onChange={setText}
          error={wrong || undefined}
          errorProps={{ fz: "sm" }}
        >
          <Stack gap={8}>
            {options.map(([id, words]) => (
              <Radio key={id} value={id} label={words} />
            ))}
          </Stack>
        </Radio.Group>
      ) : (
        <TextInput
          size="sm"
          aria-label={step.question}
          placeholder={unit ? `a number and its unit, as in 1.5 ${unit}` : "a number"}
          value={text}
          autoComplete="off"
          error={wrong || undefined}
          errorProps={{ fz: "sm" }}
          onChange={(e) => setText(e.currentTarget.value)}
        />
      )}
      <Button
        variant="filled"
        size="sm"
        type="submit"
        loading={busy}
        disabled={text.trim() === ""}
        style={{ alignSelf: "flex-start" }}
      >
        {says}
      </Button>
    </Box>
  );
}

/** Why an answer cannot be read, with a hint. */
const unread = ({ body }: ApiError): string =>
  [body.message.replace(/^answer: /, "The answer "), body.hint].filter(Boolean).join("; ");

/** "1.5 of 2 points." */
const pointsOf = (earned: number, points: number): string =>
  `${formatShort(earned, "")} of ${formatShort(points, "")} points.`;

const signed = (points: number | null | undefined): string =>
  points ? ` ${points > 0 ? "+" : ""}${formatShort(points, "")}` : "";
