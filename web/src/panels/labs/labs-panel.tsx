import { Button, NativeSelect } from "@mantine/core";
import { useRef, useState } from "react";
import { useCatalog } from "../../api/use-catalog";
import { send } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatCount, formatNumber, formatPercent, formatSi } from "../../ui/format";
import { Knob } from "../../ui/knob";
import { meanDelay } from "../lanes/delays";
import { type Lab, type LabKnob, labsOf, memorySamples } from "./lab-knobs";
import styles from "./labs.module.css";

/** Noise lab and lambda lab: make a diagnoser's assumptions wrong on purpose and watch what it costs. */
export function LabsPanel() {
  const parameters = useBench((s) => s.bench?.parameters);
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const bench = useBench((s) => s.bench?.id);
  const { block } = useCatalog();
  const turned = useRef<Promise<boolean>>(Promise.resolve(true));
  const began = useRef<{ bench: string | undefined; values: Record<string, number> }>({ bench, values: {} });
  const [wanted, setWanted] = useState<string | undefined>(undefined);
  const own = (parameters?.diagnosers ?? {}) as Record<string, unknown>;
  const ids = Object.entries(diagnosers ?? {}).flatMap(([id, { names }]) => (names.length && id in own ? [id] : []));
  const id = ids.find((name) => name === wanted) ?? ids[0];
  if (!parameters || !id)
    return (
      <EmptyState title="No diagnoser on this bench">
        Here you set the assumptions of a diagnoser apart from the real noise. Open a scenario of chapter 5 from New
        bench.
      </EmptyState>
    );
  const labs = labsOf({ parameters }, id, block);
  if (began.current.bench !== bench) began.current = { bench, values: {} };
  for (const { path, value } of labs.flatMap((lab) => lab.knobs)) began.current.values[path] ??= value;
  const countAfresh = async () => {
    await turned.current; // else a knob turned just now would go back
    const now = useBench.getState().bench;
    if (now && now.id === bench) await send({ kind: "reset", values: kept(labsOf(now, id, block)) }, "Counting afresh");
  };
  return (
    <section className={styles.panel} aria-label="Noise and memory">
      <div className={styles.bar}>
        <NativeSelect
          size="xs"
          aria-label="Diagnoser"
          value={id}
          data={ids.map((name) => ({ value: name, label: name.replaceAll("_", " ") }))}
          onChange={(e) => setWanted(e.currentTarget.value)}
        />
        <Button
          size="compact-sm"
          variant="default"
          title="Restart at tick 0; the settings here are kept"
          onClick={() => void countAfresh()}
        >
          Count afresh
        </Button>
      </div>
      <Outcome id={id} />
      <div className={styles.labs}>
        {labs.map((lab) => (
          <section key={lab.name} aria-label={lab.name}>
            <h2>{lab.name}</h2>
            <p>{lab.advice}</p>
            {lab.knobs.map((knob) => (
              <Turn
                key={knob.path}
                knob={knob}
                original={began.current.values[knob.path]}
                onChange={(value) => {
                  turned.current = send({ set: { [knob.path]: value } }, `Set ${knob.label}`);
                }}
              />
            ))}
          </section>
        ))}
      </div>
    </section>
  );
}

/** The values of every knob, to be kept over a reset. */
const kept = (labs: Lab[]): Record<string, number> =>
  Object.fromEntries(labs.flatMap((lab) => lab.knobs.map(({ path, value }) => [path, value])));

function Turn({ knob, original, onChange }: { knob: LabKnob; original: number; onChange(value: number): void }) {
  const { path, log, value, ...rest } = knob;
  const memory = path.endsWith(".forgetting") ? memorySamples(value) : undefined;
  return (
    <Knob
      {...rest}
      log={log}
      step={0}
      value={value}
      original={original}
      {...(memory === undefined
        ? {}
        : {
            note: Number.isFinite(memory) ? `remembers ${formatCount(memory, "sample")}` : "remembers everything",
          })}
      onChange={onChange}
    />
  );
}

/** What the assumptions cost: read while turning. */
function Outcome({ id }: { id: string }) {
  const score = useBench((s) => s.scores[id]);
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  if (!score) return null;
  const mean = meanDelay(score.delays);
  return (
    <dl className={styles.outcome}>
      <div>
        <dt>correct</dt>
        <dd>{formatPercent(score.correct_fraction, 2)}</dd>
      </div>
      <div>
        <dt>mean delay</dt>
        <dd>{mean === undefined ? "–" : formatSi(mean * dtMs, "ms", 3)}</dd>
      </div>
      <div>
        <dt>false switches</dt>
        <dd>{formatNumber(score.false_switches, 0)}</dd>
      </div>
      <div>
        <dt>residuals against assumed</dt>
        <dd data-off={score.nis !== null && (score.nis > OFF || score.nis < 1 / OFF)}>
          {score.nis === null ? "–" : formatNumber(score.nis, 2)}
          <small>1 if the assumptions are true</small>
        </dd>
      </div>
    </dl>
  );
}

/** Mean normalised residual beyond which the assumptions are plainly wrong. */
const OFF = 1.5;
