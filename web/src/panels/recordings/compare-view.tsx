import { Box, Button, CloseButton, NativeSelect, NumberInput, SegmentedControl } from "@mantine/core";
import { type ReactNode, useState } from "react";
import { api } from "../../api/api";
import type { Comparison, Recording } from "../../api/types";
import { showError } from "../../bench/send";
import { formatCount, formatNumber, formatShort, formatSi } from "../../ui/format";
import shared from "../../ui/row-list.module.css";
import { TableHead } from "../../ui/table-head";
import styles from "./recordings.module.css";

const SHOWN = 60;

interface CompareViewProps {
  first: Recording;
  others: Recording[];
  onClose(): void;
}

/** Two recordings compared: for each signal the largest difference, the tolerance, pass or fail. */
export function CompareView({ first, others, onClose }: CompareViewProps) {
  const candidates = others.filter((one) => one.id !== first.id && one.ticks > 0);
  const [second, setSecond] = useState(candidates[0]?.id ?? "");
  const [percent, setPercent] = useState(1);
  const [align, setAlign] = useState<"tick" | "start">("tick");
  const [found, setFound] = useState<Comparison | undefined>(undefined);
  const compare = () =>
    api
      .compare(first.id, { other: second, absolute: 0, relative: percent / 100, tolerances: {}, align })
      .then(setFound, showError);
  const rows = [...(found?.signals ?? [])].sort((a, b) => Number(a.ok) - Number(b.ok));
  const failed = rows.filter((row) => !row.ok).length;
  return (
    <section aria-label="Comparison">
      <div className={shared.form}>
        <b>{first.name} with</b>
        <NativeSelect
          label="Other recording"
          value={second}
          data={candidates.map((one) => ({
            value: one.id,
            label: `${one.name}, ${new Date(one.created).toLocaleTimeString()}`,
          }))}
          onChange={(e) => setSecond(e.currentTarget.value)}
        />
        <NumberInput
          label="Tolerance"
          title="Share of the largest value of each signal"
          suffix=" %"
          min={0}
          w={92}
          value={percent}
          onChange={(n) => setPercent(Number(n) || 0)}
        />
        <SegmentedControl
          aria-label="Align by"
          value={align}
          data={[
            { value: "tick", label: "equal ticks" },
            { value: "start", label: "first on first" },
          ]}
          onChange={(value) => setAlign(value as "tick" | "start")}
        />
        <Button variant="filled" size="xs" disabled={!second} onClick={compare}>
          Compare
        </Button>
        <CloseButton size="sm" aria-label="Close the comparison" onClick={onClose} />
      </div>
      {candidates.length === 0 && <Words>Make a second recording to compare with.</Words>}
      {found && (
        <>
          <Box component="p" p="8px 12px" c={found.ok ? "var(--running)" : "var(--alarm)"} fw={600} role="status">
            {found.ok ? "Pass" : "Fail"}: {found.signals.length - failed} of {found.signals.length} signals within{" "}
            {formatShort(percent, "%")} over {formatCount(found.ticks, "tick")}
            {found.only_in_first.length + found.only_in_second.length > 0 &&
              `; ${found.only_in_first.length + found.only_in_second.length} are in one recording alone`}
          </Box>
          <div style={{ overflowX: "auto" }}>
            <table className={`numbers ${styles.table}`}>
              <TableHead names={["signal", "largest difference", "at tick", "rms", "tolerance", "verdict"]} />
              <tbody>
                {rows.slice(0, SHOWN).map((row) => (
                  <tr key={row.signal} data-ok={row.ok}>
                    <th scope="row">{row.signal}</th>
                    <td>{formatSi(row.max_difference, row.unit)}</td>
                    <td>{formatNumber(row.at_tick, 0)}</td>
                    <td>{formatSi(row.rms_difference, row.unit)}</td>
                    <td>{formatSi(row.tolerance, row.unit)}</td>
                    <td>{row.ok ? "pass" : "fail"}</td>
                  </tr>
                ))}
              </tbody>
            </table>
          </div>
          {rows.length > SHOWN && (
            <Words>
              The first {SHOWN} of {rows.length}, failures first.
            </Words>
          )}
        </>
      )}
    </section>
  );
}

function Words({ children }: { children: ReactNode }) {
  return (
    <Box component="p" p="8px 12px">
      {children}
    </Box>
  );
}
