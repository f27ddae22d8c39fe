import { Button } from "@mantine/core";
import { useState } from "react";
import { blind } from "../../api/blind";
import { useAnswer } from "../../api/queries";
import { showError } from "../../bench/send";
import { useView } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import exercise from "../../ui/exercise.module.css";
import { jump } from "../../ui/hover";
import { NumberField } from "../../ui/number-field";
import { Stale } from "../../ui/stale";
import { Answer } from "./answer";
import { Attempts, Outcome } from "./attempts";
import styles from "./blind.module.css";

/** Hidden fault: the server hides a fault; answer with a confidence, then see the truth and the points. */
export function BlindPanel() {
  const bench = useBench((s) => s.bench?.id);
  const question = useBench((s) => s.bench?.blind) ?? undefined;
  const hasBank = useBench((s) => Object.values(s.bench?.diagnosers ?? {}).some(({ names }) => names.length > 0));
  const { value, error, since, again } = useAnswer(bench ? ["blind", bench, question?.id] : undefined, () =>
    blind.of(bench ?? ""),
  );
  const [seed, setSeed] = useState(1);
  if (!bench || (!question && !hasBank))
    return (
      <EmptyState title="Nothing to find on this bench">
        The answers are the hypotheses of its bank; open a scenario of chapter 5 from New bench.
      </EmptyState>
    );
  if (question?.game)
    return (
      <EmptyState title="A game is played on this bench">
        Hand in or end it under Lesson › Games; then a fault can be hidden here.
      </EmptyState>
    );
  const rule = value && <p className={exercise.text}>{value.rule}</p>;
  if (question)
    return (
      <section className={styles.asked} aria-label="Hidden fault">
        <Stale error={error} since={since} onRetry={again} />
        <Answer key={question.id} question={question} rule={rule} onEnded={again} />
      </section>
    );
  const answers = value?.answers ?? [];
  const last = answers.findLast((one) => one.bench === bench);
  const hide = () => {
    useView.setState({ sample: undefined });
    jump.to("live");
    void blind.hide(bench, seed).then(again, showError);
    setSeed(seed + 1);
  };
  return (
    <section className={exercise.panel} aria-label="Hidden fault">
      <Stale error={error} since={since} onRetry={again} />
      <div className={exercise.bar}>
        <Button size="sm" onClick={hide}>
          {last ? "Hide another fault" : "Hide a fault"}
        </Button>
        <span className={exercise.field}>
          seed
          <NumberField label="Seed" unit="" integer value={seed} minimum={0} maximum={2 ** 31} onCommit={setSeed} />
        </span>
      </div>
      {last && <Outcome answer={last} />}
      <p className={exercise.text}>
        The server hides a fault, or none. Until you answer you see the reference, the measurement and the voltage, and
        you may sweep the device: no log, no diagnosers, no 3D. The same seed hides the same fault.
      </p>
      {rule}
      {answers.length > 0 && <Attempts answers={answers} />}
    </section>
  );
}
