import { Button, NumberInput, TextInput } from "@mantine/core";
import { IconPlayerRecordFilled, IconPlayerStopFilled } from "@tabler/icons-react";
import { useState } from "react";
import { api } from "../../api/api";
import type { Document, Wanted } from "../../api/types";
import { layoutNow } from "../../bench/dock";
import { showError } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import rows from "../../ui/row-list.module.css";
import { type Condition, conditionText } from "../condition/condition";
import { ConditionFields } from "../condition/condition-fields";

/** A new recording: now or on a condition, with a part of the past, and its length. */
export function RecordForm({ onChanged }: { onChanged(): void }) {
  const id = useBench((s) => s.bench?.id) ?? "";
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 1;
  const title = useBench((s) => s.bench?.title) ?? "";
  const recording = useBench((s) => s.bench?.recording) ?? [];
  const armed = useBench((s) => s.bench?.armed) ?? [];
  const [draft, setDraft] = useState(NEW_DRAFT);
  const set = (part: Partial<typeof draft>) => setDraft({ ...draft, ...part });
  const hasLevel = !draft.when.signal || typeof draft.when.level === "number";
  const underWay = [...recording, ...armed];

  const start = () =>
    api
      .record(id, wantedOf({ ...draft, name: draft.name || title.slice(0, 100) }, dtMs, layoutNow()))
      .then(onChanged, showError);
  const stop = async () => {
    try {
      for (const one of underWay) await api.stopRecording(id, one);
    } catch (error) {
      showError(error);
    }
    onChanged();
  };

  return (
    <form
      className={rows.form}
      aria-label="Record"
      onSubmit={(event) => {
        event.preventDefault();
        void start();
      }}
    >
      <TextInput
        label="Name"
        placeholder={title}
        value={draft.name}
        onChange={(e) => set({ name: e.currentTarget.value })}
      />
      <NumberInput
        label="Of the past"
        suffix=" ms"
        min={0}
        w={92}
        value={draft.pastMs}
        onChange={(n) => set({ pastMs: Number(n) || 0 })}
      />
      <NumberInput
        label="Length"
        placeholder="until stopped"
        suffix=" ms"
        min={0}
        w={112}
        value={draft.lengthMs || ""}
        onChange={(n) => set({ lengthMs: Number(n) || 0 })}
      />
      <ConditionFields
        label="Begins"
        none="at once"
        condition={draft.when}
        error={hasLevel ? undefined : "Say at what value"}
        onChange={(when) => set({ when })}
      />
      <Button
        variant="filled"
        type="submit"
        size="xs"
        disabled={!hasLevel}
        leftSection={<IconPlayerRecordFilled size={14} />}
      >
        {draft.when.signal ? "Arm" : "Record"}
      </Button>
      {underWay.length > 0 && (
        <Button
          variant="filled"
          size="xs"
          color="alarm"
          leftSection={<IconPlayerStopFilled size={14} />}
          onClick={stop}
        >
          Stop {recording.length > 0 ? "recording" : "waiting"}
        </Button>
      )}
    </form>
  );
}

/** The contents of the form; times in ms of the device. */
interface RecordDraft {
  name: string;
  pastMs: number;
  /** 0: until it is stopped. */
  lengthMs: number;
  /** When it begins; without a signal at once. */
  when: Condition;
}

export const NEW_DRAFT: RecordDraft = { name: "", pastMs: 1, lengthMs: 0, when: { signal: "", above: true, level: 0 } };

/** The request of a draft, in ticks. */
export function wantedOf(draft: RecordDraft, dtMs: number, layout: Document | undefined): Wanted {
  const ticks = (ms: number) => Math.max(0, Math.round(ms / dtMs));
  return {
    name: draft.name.trim() || "recording",
    past_ticks: ticks(draft.pastMs),
    ticks: draft.lengthMs > 0 ? Math.max(1, ticks(draft.lengthMs)) : null,
    when: draft.when.signal ? conditionText(draft.when) : null,
    layout: layout ?? null,
  };
}
