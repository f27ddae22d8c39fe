import { Button, NativeSelect, NumberInput, TextInput } from "@mantine/core";
import { IconPlayerRecordFilled, IconPlayerStopFilled } from "@tabler/icons-react";
import { useState } from "react";
import { api } from "../../api/api";
import { layoutNow } from "../../app/layouts";
import { showError } from "../../app/send";
import { useBench } from "../../stream/bench-store";
import { unitText } from "../../ui/unit-scale";
import styles from "./recordings.module.css";
import { NEW_DRAFT, wantedOf } from "./wanted";

/** What to record: now or when a condition holds, with how much of the past, and for how long. */
export function RecordForm({ onChanged }: { onChanged(): void }) {
  const id = useBench((s) => s.bench?.id) ?? "";
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 1;
  const title = useBench((s) => s.bench?.title) ?? "";
  const signals = useBench((s) => s.bench?.signals) ?? [];
  const recording = useBench((s) => s.bench?.recording) ?? [];
  const armed = useBench((s) => s.bench?.armed) ?? [];
  const [draft, setDraft] = useState(NEW_DRAFT);
  const set = (part: Partial<typeof draft>) => setDraft({ ...draft, ...part });
  const unit = unitText(signals.find((s) => s.name === draft.signal)?.unit ?? "");
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
      className={styles.form}
      aria-label="Record"
      onSubmit={(event) => {
        event.preventDefault();
        void start();
      }}
    >
      <TextInput
        size="xs"
        label="Name"
        placeholder={title}
        value={draft.name}
        onChange={(e) => set({ name: e.currentTarget.value })}
      />
      <NumberInput
        size="xs"
        label="Of the past"
        suffix=" ms"
        min={0}
        w={92}
        value={draft.pastMs}
        onChange={(n) => set({ pastMs: Number(n) || 0 })}
      />
      <NumberInput
        size="xs"
        label="Length"
        placeholder="until stopped"
        suffix=" ms"
        min={0}
        w={112}
        value={draft.lengthMs || ""}
        onChange={(n) => set({ lengthMs: Number(n) || 0 })}
      />
      <NativeSelect
        size="xs"
        label="Begins"
        value={draft.signal}
        data={[{ value: "", label: "at once" }, ...signals.map((s) => ({ value: s.name, label: `when ${s.name}` }))]}
        onChange={(e) => set({ signal: e.currentTarget.value })}
      />
      {draft.signal && (
        <>
          <NativeSelect
            size="xs"
            label="is"
            value={draft.above ? ">" : "<"}
            data={[
              { value: ">", label: "above" },
              { value: "<", label: "below" },
            ]}
            onChange={(e) => set({ above: e.currentTarget.value === ">" })}
          />
          <NumberInput
            size="xs"
            label="Level"
            suffix={unit ? ` ${unit}` : ""}
            w={92}
            value={draft.level}
            onChange={(n) => set({ level: Number(n) || 0 })}
          />
        </>
      )}
      <Button type="submit" size="xs" leftSection={<IconPlayerRecordFilled size={14} />}>
        {draft.signal ? "Arm" : "Record"}
      </Button>
      {underWay.length > 0 && (
        <Button size="xs" color="alarm" leftSection={<IconPlayerStopFilled size={14} />} onClick={stop}>
          Stop {recording.length > 0 ? "recording" : "waiting"}
        </Button>
      )}
    </form>
  );
}
