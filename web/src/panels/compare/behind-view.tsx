import { ActionIcon, Box, Button, Checkbox, NativeSelect, Stack, TextInput } from "@mantine/core";
import { IconTrash, IconX } from "@tabler/icons-react";
import { type ReactNode, useState } from "react";
import { api } from "../../api/api";
import { useServed } from "../../api/me";
import { useAnswer } from "../../api/queries";
import type { Bench } from "../../api/types";
import {
  type Alignment,
  addBehind,
  align,
  MOST_BEHIND,
  removeBehind,
  renameBehind,
  useBehind,
  wordsOf,
} from "../../bench/behind";
import { showRecording, showRun } from "../../bench/behind-sources";
import { openBench } from "../../bench/open-bench";
import { showError } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatMoment, formatSi } from "../../ui/format";
import { Stale } from "../../ui/stale";

const ALIGNMENTS: { value: Alignment; label: string }[] = [
  { value: "time", label: "the same time" },
  { value: "inject", label: "the last fault of each" },
  { value: "heal", label: "the last healing of each" },
  { value: "switch", label: "the last switch of each" },
  { value: "tripped", label: "the last trip of each" },
];

interface Candidates {
  benches: Bench[];
  recordings: { id: string; name: string }[];
  runs: { id: string; label?: string; title: string }[];
}

const NONE: Candidates = { benches: [], recordings: [], runs: [] };
const LIST = { gap: 4, overflowY: "auto" } as const;

/** Other benches, branches, recordings and runs behind the traces, and the event at which they are aligned. */
export function BehindView() {
  const bench = useBench((s) => s.bench);
  if (!bench)
    return (
      <EmptyState title="No bench yet">Traces of other benches are drawn behind the traces of this bench.</EmptyState>
    );
  return (
    <section className="view-page" aria-label="Branches and runs">
      <Stack gap={8} maw={420}>
        <Sources bench={bench} />
      </Stack>
    </section>
  );
}

function Sources({ bench }: { bench: Bench }) {
  const { behind, alignment, shaded, difference } = useBehind();
  const served = useServed();
  const { value, error, since, again } = useAnswer(["behind", bench.id], async (): Promise<Candidates> => {
    const [benches, recordings, runs] = await Promise.all([
      api.benches(),
      served ? api.recordings() : [],
      served ? api.runs({ state: "done" }) : [],
    ]);
    return { benches, recordings: recordings.filter(({ dt_ms }) => dt_ms === bench.dt_ms), runs };
  });
  const sources = value ?? NONE;
  const there = (id: string) => behind.some((one) => one.bench === id);
  const others = sources.benches.filter(
    (other) => other.id !== bench.id && other.dt_ms === bench.dt_ms && !there(other.id) && !other.origin?.is_past,
  );
  const add = (value: string) => {
    const [kind, id] = [value.slice(0, 2), value.slice(2)];
    const source = { "b ": addBehind, "r ": showRecording, "h ": showRun }[kind];
    if (source) void source(id).then(again);
  };
  return (
    <>
      <Stale error={error} since={since} onRetry={again} />
      {behind.length === 0 && <Words>Traces of other benches are drawn faded behind these.</Words>}
      <Box component="ul" className="column" mah="40vh" style={LIST} aria-label="Behind the traces">
        {behind.map((one) => (
          <Row
            key={one.bench}
            id={one.bench}
            words={one.words}
            shift={one.shift}
            dtMs={bench.dt_ms}
            known={sources.benches.find(({ id }) => id === one.bench)}
            onChange={again}
          />
        ))}
      </Box>
      {behind.length < MOST_BEHIND ? (
        <NativeSelect
          label="Add"
          value=""
          data={[
            { value: "", label: "choose what to compare with" },
            { group: "Benches", items: others.map((one) => ({ value: `b ${one.id}`, label: longWords(one) })) },
            ...(served ? keptItems(sources) : []),
          ]}
          onChange={(e) => add(e.currentTarget.value)}
        />
      ) : (
        <Words>{MOST_BEHIND} are shown, which is the most.</Words>
      )}
      <NativeSelect
        label="Aligned at"
        value={alignment}
        data={ALIGNMENTS}
        onChange={(e) => void align(e.currentTarget.value as Alignment)}
      />
      <Checkbox
        label="Shade the difference from the first"
        checked={shaded}
        onChange={(e) => useBehind.setState({ shaded: e.currentTarget.checked })}
      />
      <Checkbox
        label="Draw the difference on an axis of its own"
        checked={difference}
        onChange={(e) => useBehind.setState({ difference: e.currentTarget.checked })}
      />
    </>
  );
}

/** Recordings and runs that the server has kept, to be played or carried out again. */
const keptItems = ({ recordings, runs }: Candidates) => [
  {
    group: "Recordings, played on a bench of their own",
    items: recordings.map(({ id, name }) => ({ value: `r ${id}`, label: name || id })),
  },
  {
    group: "Headless runs, carried out again on a bench",
    items: runs.map(({ id, label, title }) => ({ value: `h ${id}`, label: label || title })),
  },
];

interface RowProps {
  id: string;
  words: string;
  shift: number;
  dtMs: number;
  known: Bench | undefined;
  onChange(): void;
}

/** A bench behind the traces: its name, its shift, and its actions. */
function Row({ id, words, shift, dtMs, known, onChange }: RowProps) {
  const [name, setName] = useState(words);
  const rename = () => {
    const now = name.trim();
    if (!known || now === words || !now) return setName(words);
    api
      .nameBench(id, now)
      .then(() => renameBehind(id, now))
      .then(onChange, showError);
  };
  const close = () =>
    void api.removeBench(id).then(() => {
      removeBehind(id);
      onChange();
    }, showError);
  return (
    <li className="line">
      <TextInput
        flex={1}
        aria-label={`Name of ${words}`}
        value={name}
        maxLength={80}
        disabled={!known}
        onChange={(e) => setName(e.currentTarget.value)}
        onBlur={rename}
        onKeyDown={(e) => e.key === "Enter" && e.currentTarget.blur()}
      />
      <small>{shift === 0 ? "same time" : `${shift > 0 ? "+" : "−"}${formatSi(Math.abs(shift) * dtMs, "ms")}`}</small>
      <Button size="compact-xs" onClick={() => openBench(id)}>
        Show
      </Button>
      <ActionIcon size="sm" aria-label={`Take ${words} away`} onClick={() => removeBehind(id)}>
        <IconX size={14} />
      </ActionIcon>
      <ActionIcon size="sm" color="red" aria-label={`Close the bench ${words}`} onClick={close}>
        <IconTrash size={14} />
      </ActionIcon>
    </li>
  );
}

function Words({ children }: { children: ReactNode }) {
  return (
    <Box component="p" fz="md" c="dimmed">
      {children}
    </Box>
  );
}

const longWords = (bench: Bench) =>
  `${wordsOf(bench)}, at ${formatMoment(bench.tick * bench.dt_ms)}${bench.origin ? `, branched at ${formatMoment(bench.origin.tick * bench.dt_ms)}` : ""}`;
