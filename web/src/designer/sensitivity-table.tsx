import { Box } from "@mantine/core";
import type { Evaluation } from "../api/types";
import { formatChange, formatIn, formatSi } from "../ui/format";
import { TableHead } from "../ui/table-head";

const STEPS: [string, string][] = [
  ["beam_bias_um", "Beams 0.2 µm narrower"],
  ["comb_bias_um", "Fingers 0.2 µm narrower"],
  ["thickness_um", "Layer 0.1 µm thicker"],
  ["film_gap_um", "Gas film 0.1 µm thicker"],
  ["youngs_modulus_gpa", "Young's modulus 1 GPa higher"],
];

const COLUMNS: [string, string][] = [
  ["mass_kg", "m"],
  ["stiffness_n_m", "k"],
  ["damping_ns_m", "β"],
  ["force", "F/V"],
  ["f0_hz", "f₀"],
  ["quality_factor", "Q"],
];

/** The effect of a step of the process on the device; the beams first, since the stiffness goes with the cube of their width. */
export function SensitivityTable({ evaluation }: { evaluation: Evaluation }) {
  const { geometry, sensitivities } = evaluation;
  if (!geometry)
    return (
      <>
        <h2>Sensitivity to the process</h2>
        <Box component="p" className="note" mt={12}>
          This device is given by its figures. Choose a device with a drawing, such as LCR-350, to see the effect of the
          process.
        </Box>
      </>
    );
  const width = geometry.beam_width_um - 2 * geometry.beam_bias_um;
  const softer = sensitivities.beam_bias_um?.stiffness_n_m;
  return (
    <>
      <h2>Sensitivity to the process</h2>
      <Box component="table" className="numbers" w="100%" mt={4}>
        <TableHead names={["If the process makes", ...COLUMNS.map(([, sign]) => sign)]} />
        <tbody>
          {STEPS.map(([name, words]) => (
            <tr key={name}>
              <th scope="row">{words}</th>
              {COLUMNS.map(([key]) => {
                const change = sensitivities[name]?.[key];
                return (
                  <Box component="td" key={key} fw={Math.abs(change ?? 0) >= 10 ? 680 : undefined}>
                    {change === undefined ? "gone" : signed(change)}
                  </Box>
                );
              })}
            </tr>
          ))}
        </tbody>
      </Box>
      <Box component="p" className="note" mt={8}>
        Changes in %. The beams are {formatSi(width, "um", 3)} wide as etched
        {softer === undefined
          ? "; they would vanish with 0.2 µm less."
          : `; 1 − (1 − 0.2/w)³ (1.4.2) says ${formatIn(100 * (1 - (1 - 0.2 / width) ** 3), "%", 1)} softer, the linear rule 3 · 0.2/w ${formatIn(60 / width, "%", 1)}.`}
      </Box>
    </>
  );
}

function signed(change: number): string {
  if (Math.abs(change) < 0.05) return "0";
  return formatChange(change, "", 1);
}
