import { Table } from "@mantine/core";
import type { RecordCalibration } from "../api/types";
import { capital } from "../ui/capital";
import { formatNumber, formatShort } from "../ui/format";

const CHECKS: Record<string, string> = {
  clipped: "Share of samples at an extreme value",
  delay_change: "Change of the delay, in samples",
  residual_ratio: "Error on the half that was not fitted, over the fitted half",
  correlation: "Correlation of the errors",
  pulled: "Change of a number by a hidden effect, over its limit",
};
const ROWS = [
  { name: "mass", label: "Mass over nominal", decimals: 4, unit: "" },
  { name: "damping", label: "Damping over nominal", decimals: 4, unit: "" },
  { name: "stiffness", label: "Stiffness over nominal", decimals: 4, unit: "" },
  { name: "offset_um", label: "Offset", decimals: 4, unit: " µm" },
  { name: "delay_samples", label: "Delay", decimals: 3, unit: " samples" },
] as const;

/** The fitted device with its intervals, the test of the fit, or the reason against it. */
export function CalibrationView({ calibration }: { calibration: RecordCalibration }) {
  return (
    <section aria-label="Calibration">
      {calibration.refusal ? (
        <p role="alert" className="wrong">
          Refused: {calibration.refusal}.
        </p>
      ) : (
        <p role="status">The fit holds: half of {calibration.samples} samples were fitted, the other half tests it.</p>
      )}
      <Table aria-label="Fitted device">
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Fitted at the nominal force</Table.Th>
            <Table.Th>Value</Table.Th>
            <Table.Th>95 % interval</Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {ROWS.map(({ name, label, decimals, unit }) => {
            const { value, low, high } = calibration[name];
            const write = (number: number) => formatNumber(number, decimals);
            return (
              <Table.Tr key={name}>
                <Table.Th scope="row">{label}</Table.Th>
                <Table.Td>
                  {write(value)}
                  {unit}
                </Table.Td>
                <Table.Td>
                  {write(low)} to {write(high)}
                </Table.Td>
              </Table.Tr>
            );
          })}
          <Table.Tr>
            <Table.Th scope="row">Noise of a sample</Table.Th>
            <Table.Td>{formatShort(calibration.noise_um, "um", 3)}</Table.Td>
            <Table.Td>
              {calibration.quantum_um > 0 && `step of the converter ${formatShort(calibration.quantum_um, "um", 3)}`}
            </Table.Td>
          </Table.Tr>
        </Table.Tbody>
      </Table>
      <Table aria-label="Test of the fit" mt={8}>
        <Table.Thead>
          <Table.Tr>
            <Table.Th>Tested</Table.Th>
            <Table.Th>Found</Table.Th>
            <Table.Th>At most</Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>
          {calibration.checks.map(({ name, value, limit, ok }) => (
            <Table.Tr key={name}>
              <Table.Th scope="row">{CHECKS[name] ?? capital(name)}</Table.Th>
              <Table.Td c={ok ? undefined : "var(--alarm)"}>
                {formatNumber(value, 3)} {ok ? "" : "✗"}
              </Table.Td>
              <Table.Td>{formatNumber(limit, 3)}</Table.Td>
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
    </section>
  );
}
