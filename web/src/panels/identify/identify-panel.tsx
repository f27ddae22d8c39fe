import { Box, Button, Group } from "@mantine/core";
import { useState } from "react";
import { api } from "../../api/api";
import type { Identification } from "../../api/types";
import { useBusy } from "../../bench/use-busy";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { NumberField } from "../../ui/number-field";
import { IdentifiedTable } from "./identified-table";
import styles from "./identify.module.css";
import { SweepBode } from "./sweep-bode";

const START = { amplitude_v: 2, points: 31, cycles: 40, settle: 12 };
type Field = keyof typeof START;
const FIELDS: { name: Field; label: string; unit: string; minimum: number; maximum: number; integer: boolean }[] = [
  { name: "amplitude_v", label: "Amplitude", unit: "V", minimum: 0.001, maximum: 1000, integer: false },
  { name: "points", label: "Tones of each pass", unit: "", minimum: 4, maximum: 200, integer: true },
  { name: "cycles", label: "Cycles of each tone", unit: "", minimum: 2, maximum: 1000, integer: true },
];

/** Frequency response: the device as it is now, faults and air included, measured on a copy of the bench. */
export function IdentifyPanel() {
  const id = useBench((s) => s.bench?.id);
  const [how, setHow] = useState(START);
  const [result, setResult] = useState<Identification | undefined>(undefined);
  const [busy, during] = useBusy();
  if (!id) return <EmptyState title="No bench yet">A sweep measures the device of a bench.</EmptyState>;

  const sweep = () =>
    during(async () => {
      setResult(await api.identify(id, { ...how, start_hz: null, stop_hz: null }));
    });
  const button = (
    <Button variant="filled" size="xs" loading={busy} onClick={sweep}>
      {result ? "Sweep again" : "Sweep the device"}
    </Button>
  );
  return (
    <Box component="section" className="view" p="8px 12px" aria-label="Frequency response">
      <Box className="row" pb={8}>
        {button}
        {FIELDS.map(({ name, ...field }) => (
          <Group key={name} gap={6} wrap="nowrap" className="note">
            {field.label}
            <NumberField {...field} value={how[name]} onCommit={(value) => setHow({ ...how, [name]: value })} />
          </Group>
        ))}
      </Box>
      {result ? (
        <div className={styles.result}>
          <div className={styles.bode}>
            <SweepBode result={result} />
          </div>
          <IdentifiedTable result={result} />
        </div>
      ) : (
        <EmptyState title="Not measured yet">
          Sines are played on a copy of this bench, with the faults and the air it has now; the bench itself runs on. A
          mass, a damper and a spring are fitted to the output of the sensor.
        </EmptyState>
      )}
    </Box>
  );
}
