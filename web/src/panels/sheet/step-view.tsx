import { Box, Button, Radio, TextInput } from "@mantine/core";
import { type FormEvent, useState } from "react";
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

/** A step of a sheet: what is checked, what is still missing, what was answered, how points come and go. */
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
        <ul className={styles.answers} aria-label="Answers">
          {answers.map((given, i) => (
            // biome-ignore lint/suspicious/noArrayIndexKey: answers are only ever added
            <li key={i} data-right={given.points === null ? undefined : (given.points ?? 0) > 0}>
              <b>{given.text}</b>
              {given.reason === null ? " – committed; judged after the run" : ` – ${given.reason}`}
              {given.points !== null && (
                <Box component="span" ml={6} fw={600}>
                  {signed(given.points)}
                </Box>
              )}
            </li>
          ))}
        </ul>
      )}
      {isOpen && step.kind !== "hold" && step.kind !== "blind" && (
        <AnswerForm key={answers.length} step={step} actions={actions} />
      )}
      {hints.map((hint) => (
        <p key={hint} className={styles.hint}>
          Hint: {hint}
        </p>
      ))}
      {step.solution && !isOpen && <p className={styles.solution}>Right answer: {step.solution}</p>}
      {step.given_up && <p className={styles.quiet}>Closed as it was.</p>}
      <p className={styles.rule}>
        {!isOpen && earned !== null && <b>{pointsOf(earned, points)} </b>}
        {rule}
        {isOpen &&
          step.tries_left != null &&
          step.kind === "question" &&
          ` ${formatCount(step.tries_left, "attempt")} left.`}
      </p>
      {isOpen && (
        <div className={styles.buttons}>
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
        </div>
      )}
    </div>
  );
}

/** The quantities, the range of each, a tick where it holds; how long they hold of how long they have to. */
function Conditions({ step, isOpen }: { step: SheetStep; isOpen: boolean }) {
  return (
    <>
      <ul className={`column ${styles.conditions}`} aria-label="What is checked">
        {(step.conditions ?? []).map(({ label, now, wanted, holds }) => (
          <li key={label} data-holds={holds}>
            <span aria-hidden="true">{holds ? "✓" : "○"}</span>
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
          </li>
        ))}
      </ul>
      {isOpen && (
        <div className={`line ${styles.held}`}>
          <progress aria-label="Held" max={1} value={step.held_share} />
          <span>{step.held}</span>
        </div>
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
    <form className={`column ${styles.form}`} onSubmit={(event) => void take(event)}>
      {options.length > 0 ? (
        <Radio.Group
          label={step.question}
          labelProps={{ className: "visually-hidden" }}
          value={text}
          onChange={setText}
          error={wrong || undefined}
        >
          <div className={`column ${styles.options}`}>
            {options.map(([id, words]) => (
              <Radio key={id} value={id} label={words} />
            ))}
          </div>
        </Radio.Group>
      ) : (
        <TextInput
          size="sm"
          aria-label={step.question}
          placeholder={unit ? `a number and its unit, as in 1.5 ${unit}` : "a number"}
          value={text}
          autoComplete="off"
          error={wrong || undefined}
          onChange={(e) => setText(e.currentTarget.value)}
        />
      )}
      <Button variant="filled" size="sm" type="submit" loading={busy} disabled={text.trim() === ""}>
        {says}
      </Button>
    </form>
  );
}

/** Why an answer cannot be read, and how it can. */
const unread = ({ body }: ApiError): string =>
  [body.message.replace(/^answer: /, "The answer "), body.hint].filter(Boolean).join("; ");

/** "1.5 of 2 points." */
export const pointsOf = (earned: number, points: number): string =>
  `${formatShort(earned, "")} of ${formatShort(points, "")} points.`;

const signed = (points: number | null | undefined): string =>
  points ? ` ${points > 0 ? "+" : ""}${formatShort(points, "")}` : "";
