import { Button, Group, TextInput } from "@mantine/core";
import { useState } from "react";
import { api } from "../api/api";
import { useMay } from "../api/me";
import type { HealthyStretch } from "../api/types";
import { useBusy } from "../bench/use-busy";

/** Keep the calibrated device under a name, for any bench; the teacher's alone. */
export function SaveDevice({ record, stretch }: { record: string; stretch: HealthyStretch }) {
  const [name, setName] = useState("");
  const [kept, setKept] = useState("");
  const [busy, during] = useBusy();
  if (!useMay("teach")) return null;
  if (kept) return <p role="status">Kept as {kept}: New bench has it among the devices.</p>;
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        void during(async () =>
          setKept((await api.saveMeasuredDevice({ ...stretch, record, name: name.trim() })).name),
        );
      }}
    >
      <Group gap={8} align="end" my={8}>
        <TextInput
          label="Keep this device as"
          maxLength={100}
          value={name}
          onChange={(e) => setName(e.currentTarget.value)}
        />
        <Button type="submit" disabled={!name.trim()} loading={busy}>
          Keep
        </Button>
      </Group>
    </form>
  );
}
