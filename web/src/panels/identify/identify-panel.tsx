import { Box, Button, Group } from "@mantine/core";
import { useEffect, useRef, useState } from "react";
import { api } from "../../api/api";
import type { Identification } from "../../api/types";
import { useBusy } from "../../bench/use-busy";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatChange, formatSpread, formatTick } from "../../ui/format";
import { NumberField } from "../../ui/number-field";
import { TableHead } from "../../ui/table-head";
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

type Found = Identification["found"];
type Key = keyof Found;

const ROWS: { label: string; value: Key; error: Key; unit: string }[] = [
  { label: "Peak", value: "f_peak_hz", error: "f_peak_error_hz", unit: "Hz" },
  { label: "Resonance f₀", value: "f0_hz", error: "f0_error_hz", unit: "Hz" },
  { label: "Quality factor", value: "quality_factor", error: "quality_factor_error", unit: "1" },
  { label: "Mass m", value: "mass_kg", error: "mass_error_kg", unit: "kg" },
  { label: "Stiffness k", value: "stiffness_n_m", error: "stiffness_error_n_m", unit: "N/m" },
  { label: "Damping β", value: "damping_ns_m", error: "damping_error_ns_m", unit: "N s/m" },
];

/** The device by the sweep, with standard errors, and its distance from the nominal device. */
function IdentifiedTable({ result }: { result: Identification }) {
  const table = useRef<HTMLTableElement>(null);
  // the numbers come into sight in a panel of any height
  useEffect(() => {
    if (result) table.current?.scrollIntoView({ block: "nearest" });
  }, [result]);
  return (
    <table ref={table} className={`numbers ${styles.table}`}>
      <TableHead names={[`At ${formatTick(result.tick)}`, "Measured ± standard error", "From nominal"]} />
      <tbody>
        {ROWS.map(({ label, value, error, unit }) => {
          const nominal = result.nominal[value];
          const found = Number(result.found[value]);
          const sigma = Number(result.found[error]);
          const change = 100 * (found / nominal - 1);
          const sure = Math.abs(found - nominal) > 3 * sigma && Math.abs(change) >= 0.5;
          return (
            <tr key={value}>
              <th scope="row">{label}</th>
              <td>
                <b>{formatSpread("", found, sigma, unit)}</b>
              </td>
              <Box component="td" data-sure={sure} fw={sure ? 700 : undefined}>
                {formatChange(change, "%", 2)}
              </Box>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}
