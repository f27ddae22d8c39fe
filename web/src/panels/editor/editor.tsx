import { Box, Button, Switch, Text, TextInput } from "@mantine/core";
import { useEffect, useState } from "react";
import { useWatches } from "../../api/me";
import { useAnswer } from "../../api/queries";
import type { UnitMistake } from "../../api/types";
import { units } from "../../api/units";
import { editCopy } from "../../bench/edit-unit";
import { beginWith, isUnitName, nameOfClass, useDraft } from "../../bench/unit-draft";
import { sourceOnBench } from "../../bench/unit-values";
import { useBench } from "../../stream/bench-store";
import { sentence } from "../../ui/capital";
import { EmptyState } from "../../ui/empty-state";
import { Code } from "./code";
import { Difference } from "./difference";
import styles from "./editor.module.css";
import { Headless } from "./headless";
import { OnBench } from "./on-bench";
import { StartFrom } from "./start-from";
import { UnitFacts } from "./unit-facts";
import { type Check, type Checked, useCheck } from "./use-check";
import { type Run, useRun } from "./use-run";
import { Versions } from "./versions";

/** Write a unit: its text at the left, its facts at the right. */
export function Editor() {
  const watches = useWatches();
  const list = useAnswer(watches ? undefined : ["texts of units"], units.all);
  if (watches) return <EmptyState title="No units here">A link to watch shows one bench.</EmptyState>;
  if (list.value?.refusal) return <EmptyState title="No units here">{sentence(list.value.refusal)}</EmptyState>;
  return <Bench list={list} />;
}

function Bench({ list }: { list: Parameters<typeof StartFrom>[0]["list"] }) {
  const { name, source, asYouType } = useDraft();
  const versions = useDraft((s) => s.versions[name]);
  const [chosen, choose] = useState<number | undefined>(undefined);
  const checked = useCheck();
  const run = useRun(checked.now);
  const version = versions?.find((one) => one.at === chosen);
  const isThere = useBench((s) => sourceOnBench(s.bench?.parameters, name) !== undefined);
  const { unit } = checked;

  // a text without a name gets the name of its class
  useEffect(() => {
    const found = checked.now?.unit && !name ? nameOfClass(source) : "";
    if (found) useDraft.setState({ name: found });
  }, [checked.now, name, source]);

  return (
    <section className={`column ${styles.panel}`} aria-label="Editor">
      <Box className="row" flex="none" p="6px 12px 2px">
        <StartFrom list={list} unit={checked.now?.unit ?? undefined} />
        <TextInput
          aria-label="Name of the unit"
          placeholder="name"
          w="16ch"
          value={name}
          maxLength={32}
          error={name !== "" && !isUnitName(name)}
          onChange={(e) => useDraft.setState({ name: e.currentTarget.value })}
        />
        <Versions chosen={chosen} onChoose={choose} />
      </Box>
      <Box className="row" flex="none" p="6px 12px 2px">
        <State name={name} source={source} checked={checked} run={run} />
        <Switch
          label="Run as I type"
          checked={asYouType}
          onChange={(e) => useDraft.setState({ asYouType: e.currentTarget.checked })}
        />
        <Button
          variant="filled"
          size="xs"
          loading={run.busy}
          disabled={!checked.now?.unit || !isUnitName(name) || run.isOn}
          onClick={run.start}
        >
          Run
        </Button>
      </Box>
      <div className={styles.body}>
        {version ? (
          <Difference
            version={version}
            source={source}
            onBack={() => {
              beginWith(name, version.source);
              choose(undefined);
            }}
            onClose={() => choose(undefined)}
          />
        ) : (
          <Code
            source={source}
            onChange={(text) => useDraft.setState({ source: text })}
            mistakes={checked.now?.errors}
            card={unit?.card}
          />
        )}
        <aside className={styles.facts} aria-label="The unit">
          {unit ? (
            <>
              {isThere && <OnBench card={unit.card} />}
              <UnitFacts unit={unit} />
              <Headless key={unit.card.name} card={unit.card} source={source} ready={Boolean(checked.now?.unit)} />
            </>
          ) : (
            <EmptyState
              title="No unit yet"
              action={
                <Button variant="filled" size="xs" onClick={() => void editCopy("blank")}>
                  Start with three lines
                </Button>
              }
            >
              Or start from the PI or a unit of the library, open a file, or type. Title, equations, parameters and
              signals of the unit appear here.
            </EmptyState>
          )}
        </aside>
      </div>
    </section>
  );
}

/** The state of the text, in a line. */
function State({ name, source, checked, run }: { name: string; source: string; checked: Checked; run: Run }) {
  const { text, isWrong } = stateOf(name, source, checked.now, checked.refusal, run);
  return (
    <Text
      inherit
      role="status"
      flex="1 1 30ch"
      miw={0}
      c={isWrong ? "var(--alarm)" : "dimmed"}
      style={{ overflowWrap: "anywhere" }}
    >
      {text}
    </Text>
  );
}

const placed = ({ line, column, message }: UnitMistake) => `Line ${line}, column ${column}: ${message}.`;

const others = (count: number) => (count ? ` ${count} more in the text, underlined.` : "");

function stateOf(name: string, source: string, check: Check | undefined, refusal: string | undefined, run: Run) {
  const wrong = (text: string) => ({ text, isWrong: true });
  const fine = (text: string) => ({ text, isWrong: false });
  if (!source.trim()) return fine("Empty.");
  if (name && !isUnitName(name)) return wrong("The name: small letters, digits and _, a letter first, at most 32.");
  if (check?.errors[0]) return wrong(`${placed(check.errors[0])}${others(check.errors.length - 1)}`);
  if (run.busy) return fine("Checked. It is being compiled for this bench.");
  if (run.refusal) return wrong(`Checked, but the bench did not take it: ${run.refusal}.`);
  if (run.trip) return wrong(`Checked, but it has tripped the bench: ${run.trip}. Change it, or go back.`);
  if (run.isOn) return fine("Checked. It runs on this bench since tick 0.");
  if (check) return fine("Checked. It does not run on this bench yet.");
  return refusal ? wrong(sentence(refusal)) : fine("Being checked.");
}
