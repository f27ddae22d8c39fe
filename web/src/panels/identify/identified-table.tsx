import { Box } from "@mantine/core";
import type { Identification } from "../../api/types";
import { formatChange, formatSpread, formatTick } from "../../ui/format";
import { TableHead } from "../../ui/table-head";
import styles from "./identify.module.css";

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
export function IdentifiedTable({ result }: { result: Identification }) {
  return (
    <table className={`numbers ${styles.table}`}>
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
