import { Button, Radio, Slider } from "@mantine/core";
import { useState } from "react";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatCount, formatNumber, formatPercent, formatSi } from "../../ui/format";
import { jump } from "../../ui/hover";
import { NumberField } from "../../ui/number-field";
import type { Hypothesis } from "../hypotheses/draft";
import styles from "./blind.module.css";
import { commit, giveUp, hide, useGame } from "./use-blind";

type Banks = Record<string, { hypotheses?: Hypothesis[] }>;

/** Blind diagnosis: a fault hidden by a seed; answer with a confidence, then see the truth and the points. */
export function BlindPanel() {
  const bench = useBench((s) => s.bench?.id);
  const parameters = useBench((s) => s.bench?.parameters);
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const { hidden, last, attempts } = useGame();
  const [seed, setSeed] = useState(1);
  const list = Object.values((parameters?.diagnosers ?? {}) as Banks).find((bank) => bank.hypotheses)?.hypotheses;
  if (!bench || !list)
    return (
      <EmptyState title="Nothing to find on this bench">
        The answers are the hypotheses of its bank; open a scenario of chapter 5 from New bench.
      </EmptyState>
    );
  if (hidden?.bench === bench) return <Answer list={list} dtMs={dtMs} />;
  return (
    <section className={styles.panel} aria-label="Blind diagnosis">
      {last && <Outcome />}
      {hidden && <p className={styles.advice}>A game waits on another bench; hiding a fault here ends it.</p>}
      <p className={styles.advice}>
        A fault is hidden, or none. Faults, log, 3D and the diagnosers keep it to themselves until you commit an answer
        with your confidence. The same seed hides the same fault.
      </p>
      <div className={styles.bar}>
        <span className={styles.field}>
          seed
          <NumberField label="Seed" unit="" integer value={seed} minimum={0} maximum={2 ** 31} onCommit={setSeed} />
        </span>
        <Button
          size="sm"
          onClick={() => {
            void hide(bench, seed, list, dtMs);
            setSeed(seed + 1);
          }}
        >
          Hide a fault
        </Button>
      </div>
      {attempts.length > 0 && <Attempts />}
    </section>
  );
}

function Answer({ list, dtMs }: { list: Hypothesis[]; dtMs: number }) {
  const [said, setSaid] = useState<string | undefined>(undefined);
  const [confidence, setConfidence] = useState(70);
  const take = () => said && commit({ said, confidence: confidence / 100 }, list, dtMs);
  return (
    <section className={styles.panel} aria-label="Blind diagnosis">
      <Radio.Group label="What is the device now?" value={said ?? ""} onChange={setSaid}>
        <div className={styles.answers}>
          {list.map(({ name }) => (
            <Radio key={name} value={name} label={hypothesisWords(name)} />
          ))}
        </div>
      </Radio.Group>
      <label className={styles.confidence} htmlFor="confidence">
        How sure are you? <strong>{formatPercent(confidence / 100, 0)}</strong>
      </label>
      <Slider
        id="confidence"
        thumbLabel="How sure are you, percent"
        min={Math.ceil(100 / list.length)}
        max={100}
        label={null}
        value={confidence}
        onChange={setConfidence}
      />
      <div className={styles.bar}>
        <Button size="sm" disabled={said === undefined} onClick={take}>
          Commit the answer
        </Button>
        <Button size="sm" variant="subtle" onClick={giveUp}>
          Give up
        </Button>
      </div>
    </section>
  );
}

function Outcome() {
  const { last, faultTick } = useGame();
  if (!last) return null;
  const right = last.said === last.truth;
  return (
    <div className={styles.outcome} role="status">
      <p className={styles.verdict} data-right={right}>
        {right ? "Right" : "Wrong"}: it is {hypothesisWords(last.truth)}. {formatCount(last.points, "point")}
      </p>
      <p className={styles.advice}>
        You said {hypothesisWords(last.said)} with {formatPercent(last.confidence, 0)}
        {last.tookMs !== null
          ? `, ${formatSi(last.tookMs, "ms", 3)} of device time after the fault`
          : ", and no fault had come"}
        .{" "}
        {Object.entries(last.verdicts)
          .map(([id, verdict]) => `${id.replaceAll("_", " ")} said ${hypothesisWords(verdict)}`)
          .join(", ")}
        .
      </p>
      {faultTick !== undefined && (
        <Button size="compact-sm" variant="default" onClick={() => jump.to({ tick: faultTick })}>
          Show the moment it came
        </Button>
      )}
    </div>
  );
}

function Attempts() {
  const attempts = useGame((s) => s.attempts);
  const mean = attempts.reduce((sum, a) => sum + a.points, 0) / attempts.length;
  return (
    <table className={styles.table}>
      <caption>
        {formatCount(attempts.length, "answer")}, {formatCount(mean, "point")} on average
      </caption>
      <thead>
        <tr>
          <th scope="col">Seed</th>
          <th scope="col">Said</th>
          <th scope="col">Truth</th>
          <th scope="col">Sure</th>
          <th scope="col">Points</th>
        </tr>
      </thead>
      <tbody>
        {attempts.map((attempt, i) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: attempts are only ever added
          <tr key={i} data-right={attempt.said === attempt.truth}>
            <td>{attempt.seed}</td>
            <td>{hypothesisWords(attempt.said)}</td>
            <td>{hypothesisWords(attempt.truth)}</td>
            <td>{formatPercent(attempt.confidence, 0)}</td>
            <td>{formatNumber(attempt.points, 0)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
