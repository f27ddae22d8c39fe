import { Box, Button, NativeSelect } from "@mantine/core";
import { useRef, useState } from "react";
import { useCatalog } from "../../api/use-catalog";
import { send } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { Figure } from "../../ui/figure";
import { formatCount, formatNumber, formatPercent, formatSi } from "../../ui/format";
import { Knob } from "../../ui/knob";
import { meanDelay } from "../lanes/delays";
import { type Lab, type LabKnob, labsOf, memorySamples } from "./lab-knobs";
import styles from "./labs.module.css";

/** Noise lab and lambda lab: make the assumptions of a diagnoser wrong on purpose and watch the cost. */
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
    <section className="view-page" aria-label="Noise and memory">
      <Box className="row" pb={8}>
        <NativeSelect
          aria-label="Diagnoser"
          value={id}
          data={ids.map((name) => ({ value: name, label: name.replaceAll("_", " ") }))}
          onChange={(e) => setWanted(e.currentTarget.value)}
        />
        <Button title="Restart at tick 0; the settings here are kept" onClick={() => void countAfresh()}>
          Count afresh
        </Button>
      </Box>
      <Outcome id={id} />
      <div className={styles.labs}>
        {labs.map((lab) => (
          <section key={lab.name} aria-label={lab.name}>
            <Box component="h2" mt={8}>
              {lab.name}
            </Box>
            <Box component="p" className="remark" mb={4}>
              {lab.advice}
            </Box>
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
  const { path, ...rest } = knob;
  const memory = path.endsWith(".forgetting") ? memorySamples(knob.value) : undefined;
  return (
    <Knob
      {...rest}
      step={0}
      original={original}
      note={
        memory === undefined
          ? undefined
          : Number.isFinite(memory)
            ? `remembers ${formatCount(memory, "sample")}`
            : "remembers everything"
      }
      onChange={onChange}
    />
  );
}

/** The cost of the assumptions. */
function Outcome({ id }: { id: string }) {
  const score = useBench((s) => s.scores[id]);
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  if (!score) return null;
  const mean = meanDelay(score.delays);
  const isOff = score.nis !== null && (score.nis > OFF || score.nis < 1 / OFF);
  return (
    <Box component="dl" className={`row ${styles.outcome}`} mb={8}>
      <Figure name="correct">{formatPercent(score.correct_fraction, 2)}</Figure>
      <Figure name="mean delay">{mean === undefined ? "–" : formatSi(mean * dtMs, "ms", 3)}</Figure>
      <Figure name="false switches">{formatNumber(score.false_switches, 0)}</Figure>
      <Figure name="residuals against assumed" data-off={isOff} c={isOff ? "var(--alarm)" : undefined}>
        {score.nis === null ? "–" : formatNumber(score.nis, 2)}
        <Box component="small" ml={8}>
          1 if the assumptions are true
        </Box>
      </Figure>
    </Box>
  );
}

/** Mean normalised residual beyond which the assumptions are plainly wrong. */
const OFF = 1.5;
