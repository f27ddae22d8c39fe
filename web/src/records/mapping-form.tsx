import { Button, NativeSelect, NumberInput, Stack } from "@mantine/core";
import { useState } from "react";
import type { FileColumns, RecordReading } from "../api/types";

const PARTS = [
  { part: "drive", label: "Column of the drive voltage" },
  { part: "displacement", label: "Column of the displacement" },
] as const;
const NONE = "";

interface MappingFormProps {
  columns: FileColumns;
  busy: boolean;
  onRead(reading: RecordReading): void;
}

/** Asks for the columns and the rate that were not found; nothing where all were. */
export function MappingForm({ columns, busy, onRead }: MappingFormProps) {
  const [named, setNamed] = useState<Partial<Record<"drive" | "displacement" | "time", string>>>({});
  const [rate, setRate] = useState<number | string>("");
  const numbers = columns.columns.filter((column) => column.is_number);
  const asked = PARTS.filter(({ part }) => !columns.found[part]);
  const asksTime = !columns.found.time;
  if (asked.length === 0 && !asksTime) return null;
  const options = (none: string) => [
    { value: NONE, label: none },
    ...numbers.map(({ name, unit }) => ({ value: name, label: unit ? `${name}, in ${unit}` : name })),
  ];
  const isRegular = asksTime && !named.time;
  const isWhole = asked.every(({ part }) => named[part]) && (!isRegular || Number(rate) > 0);
  return (
    <form
      aria-label="Columns of the file"
      onSubmit={(event) => {
        event.preventDefault();
        onRead({ ...named, ...(isRegular ? { rate_khz: Number(rate) } : {}) });
      }}
    >
      <Stack gap={8} my={8} maw={420}>
        {asked.map(({ part, label }) => (
          <NativeSelect
            key={part}
            label={label}
            value={named[part] ?? NONE}
            data={options("choose")}
            onChange={(e) => setNamed({ ...named, [part]: e.currentTarget.value })}
          />
        ))}
        {asksTime && (
          <NativeSelect
            label="Column of the times"
            value={named.time ?? NONE}
            data={options("none: the samples are regular")}
            onChange={(e) => setNamed({ ...named, time: e.currentTarget.value || undefined })}
          />
        )}
        {isRegular && (
          <NumberInput
            label="Samples for each ms"
            description="The sample rate, kHz"
            min={0}
            value={rate}
            onChange={setRate}
          />
        )}
        <Button type="submit" variant="filled" disabled={!isWhole} loading={busy}>
          Read the record
        </Button>
      </Stack>
    </form>
  );
}
