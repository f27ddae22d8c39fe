import {
  Button,
  Checkbox,
  FileInput,
  Group,
  NumberInput,
  type NumberInputProps,
  SegmentedControl,
  Select,
  Stack,
  Textarea,
  TextInput,
} from "@mantine/core";
import { IconPlayerTrackNext } from "@tabler/icons-react";
import { useEffect, useMemo, useState } from "react";
import { api } from "../api/api";
import { ApiError } from "../api/client";
import type { ApiErrorBody, ScenarioSummary } from "../api/types";
import { showError } from "../bench/send";
import { formatCount } from "../ui/format";
import { campaignOf, type Draft, EMPTY_RANGE, newDraft, pathsOf, pointCount, runOf } from "./draft";
import styles from "./runs.module.css";
import type { Chosen } from "./use-chosen";
import { PathRows, ValueRows } from "./value-rows";

const FIRST = "ch5-seven-step";

/** What to run: a scenario with other values, over seeds, a grid, a hypercube, a table, or devices of the process. */
export function StartForm({ onStarted }: { onStarted(chosen: Chosen): void }) {
  const [draft, setDraft] = useState<Draft>(() => newDraft(FIRST));
  const [library, setLibrary] = useState<ScenarioSummary[]>([]);
  const [document, setDocument] = useState<unknown>(undefined);
  const [refusal, setRefusal] = useState<ApiErrorBody | undefined>(undefined);
  const [busy, setBusy] = useState(false);
  const set = (part: Partial<Draft>) => setDraft({ ...draft, ...part });

  useEffect(() => {
    api.scenarios().then(setLibrary, showError);
  }, []);
  useEffect(() => {
    api.scenario(draft.scenario).then((found) => setDocument(found.document), showError);
  }, [draft.scenario]);
  const paths = useMemo(() => pathsOf(document), [document]);
  const isRun = draft.kind === "run";
  const points = isRun ? 1 : pointCount(draft);
  const seeds = Math.max(1, draft.seeds);
  const total = points * seeds;

  const start = async () => {
    setBusy(true);
    setRefusal(undefined);
    try {
      const { id } = isRun ? await api.startRun(runOf(draft)) : await api.startSweep(campaignOf(draft), draft.label);
      onStarted({ kind: draft.kind, id });
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      setRefusal(error.body);
    } finally {
      setBusy(false);
    }
  };

  return (
    <Stack
      component="form"
      gap={12}
      aria-label="Start"
      onSubmit={(event) => {
        event.preventDefault();
        void start();
      }}
    >
      <SegmentedControl
        fullWidth
        aria-label="What to start"
        value={draft.kind}
        data={[
          { value: "run", label: "One run" },
          { value: "campaign", label: "Campaign" },
        ]}
        onChange={(kind) => set({ kind: kind as Draft["kind"] })}
      />
      <Select
        label="Scenario"
        searchable
        allowDeselect={false}
        nothingFoundMessage="There is no scenario of this name"
        value={draft.scenario}
        data={library.map((s) => ({ value: s.id, label: s.title ? `${s.id}: ${s.title}` : s.id }))}
        onChange={(scenario) => scenario && set({ scenario })}
      />
      <TextInput
        label="Name"
        placeholder="Default: scenario title"
        maxLength={120}
        value={draft.label}
        onChange={(e) => set({ label: e.currentTarget.value })}
      />
      <ValueRows
        label="With other values"
        more="Change a value"
        placeholder="0.6"
        rows={draft.set}
        paths={paths}
        onChange={(rows) => set({ set: rows })}
      />
      {!isRun && (
        <>
          <SegmentedControl
            fullWidth
            aria-label="How to vary"
            value={draft.vary}
            data={[
              { value: "grid", label: "Grid" },
              { value: "hypercube", label: "Hypercube" },
              { value: "table", label: "Table" },
              { value: "nothing", label: "Seeds alone" },
            ]}
            onChange={(vary) => set({ vary: vary as Draft["vary"] })}
          />
          {draft.vary === "grid" && (
            <ValueRows
              label="Grid over"
              more="Vary another value"
              placeholder="0.05, 0.2  or  1:10:4"
              rows={draft.grid}
              paths={paths}
              onChange={(grid) => set({ grid })}
            />
          )}
          {draft.vary === "table" && <PointTable table={draft.table} set={set} />}
          {draft.vary === "hypercube" && <Hypercube draft={draft} paths={paths} set={set} />}
          <WholeNumber
            label="Random devices"
            description="0 = use the scenario's device. Needs a device with a drawing, such as lcr-350."
            min={0}
            max={100_000}
            value={draft.devices}
            onChange={(devices) => set({ devices })}
          />
        </>
      )}
      <Group grow gap={12} align="flex-end">
        <WholeNumber label="First seed" min={0} value={draft.firstSeed} onChange={(firstSeed) => set({ firstSeed })} />
        <WholeNumber
          label="Seeds"
          min={1}
          max={isRun ? 200 : 100_000}
          value={draft.seeds || ""}
          onChange={(seeds) => set({ seeds })}
        />
      </Group>
      {isRun && (
        <Checkbox
          label="Keep all signals"
          description="Also of controllers and sensors that are not in use. The figures are the same."
          checked={draft.all}
          onChange={(e) => set({ all: e.currentTarget.checked })}
        />
      )}
      {refusal && (
        <p className="wrong" role="alert">
          {refusal.field && !refusal.message.includes(refusal.field) && <b>{refusal.field}: </b>}
          {refusal.message}. {refusal.hint}
        </p>
      )}
      <Button variant="filled" type="submit" size="sm" loading={busy} leftSection={<IconPlayerTrackNext size={17} />}>
        {isRun
          ? `Run ${draft.seeds > 1 ? formatCount(draft.seeds, "seed") : ""}`
          : `Start ${formatCount(total, "run")}`}
      </Button>
      <p className="note">
        {!isRun && `${formatCount(points, "point")} with ${formatCount(seeds, "seed")} each. `}
        Runs work in the background, after the live benches. Runs whose results are stored are not repeated.
      </p>
    </Stack>
  );
}

/** Points that another program has chosen: a CSV file, or rows pasted as text. */
function PointTable({ table, set }: { table: string; set(part: Partial<Draft>): void }) {
  const read = async (file: File | null) => file && set({ table: await file.text() });
  return (
    <>
      <FileInput
        label="CSV file"
        placeholder="Choose a file"
        accept=".csv,text/csv"
        onChange={(file) => void read(file)}
      />
      <Textarea
        label="Rows"
        description="The header has dotted paths of the scenario; each row below is a point."
        placeholder={"sensor.noise_um,controller.kind\n0.05,mrac\n0.2,pid"}
        autosize
        minRows={3}
        maxRows={8}
        spellCheck={false}
        value={table}
        onChange={(e) => set({ table: e.currentTarget.value })}
      />
    </>
  );
}

function Hypercube({ draft, paths, set }: { draft: Draft; paths: string[]; set(part: Partial<Draft>): void }) {
  return (
    <>
      <PathRows
        label="Spread evenly over"
        more="Another range"
        rows={draft.ranges}
        paths={paths}
        empty={EMPTY_RANGE}
        onChange={(ranges) => set({ ranges })}
        entry={(row, change, name) => (
          <span className={styles.bounds}>
            <TextInput
              aria-label={`${name}: from`}
              placeholder="from"
              value={row.min}
              onChange={(e) => change({ ...row, min: e.currentTarget.value })}
            />
            <TextInput
              aria-label={`${name}: to`}
              placeholder="to"
              value={row.max}
              onChange={(e) => change({ ...row, max: e.currentTarget.value })}
            />
            <Checkbox
              label="log"
              aria-label={`${name}: logarithmic`}
              checked={row.log}
              onChange={(e) => change({ ...row, log: e.currentTarget.checked })}
            />
          </span>
        )}
      />
      <Group grow gap={12} align="flex-end">
        <WholeNumber
          label="Points"
          min={1}
          max={100_000}
          value={draft.points || ""}
          onChange={(points) => set({ points })}
        />
        <WholeNumber
          label="Seed of the points"
          min={0}
          value={draft.hypercubeSeed}
          onChange={(hypercubeSeed) => set({ hypercubeSeed })}
        />
      </Group>
    </>
  );
}

/** A field for a whole number; an empty field is 0. */
function WholeNumber({ onChange, ...field }: Omit<NumberInputProps, "onChange"> & { onChange(value: number): void }) {
  return <NumberInput allowDecimal={false} {...field} onChange={(value) => onChange(Number(value) || 0)} />;
}
