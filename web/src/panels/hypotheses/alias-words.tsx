import { Box } from "@mantine/core";
import type { AliasReport } from "../../api/types";
import { formatIn, formatSi } from "../../ui/format";
import styles from "./hypotheses.module.css";

const SHOWN = 4;

/** The closest pairs in numbers, and the equivalent of one parameter in another. */
export function AliasWords({ report }: { report: AliasReport }) {
  const { pairs, responses, stiffness_per_mass: worth, tones_hz: tones } = report.map;
  const noise = report.sensor_noise_um;
  const likenesses = responses.flatMap(({ name, equivalents }) =>
    Object.entries(equivalents).map(([factor, value]) => ({ name, factor, value })),
  );
  return (
    <>
      <table className={styles.table}>
        <caption>Closest pairs at {tones.map((f) => formatSi(f, "Hz", 3)).join(", ")}</caption>
        <tbody>
          {pairs.slice(0, SHOWN).map(({ first, second, distance_um: distance, coincident }) => (
            <Box component="tr" key={`${first} ${second}`} c={coincident ? "var(--alarm)" : undefined}>
              <th scope="row">
                {first} and {second}
              </th>
              <td>{formatSi(distance, "um", 3)}</td>
              <td>{coincident ? "aliases" : noise > 0 ? `${formatSi(distance / noise, "×", 3)} noise` : ""}</td>
            </Box>
          ))}
        </tbody>
      </table>
      <Box component="p" maw="70ch" mt={4} c="dimmed">
        {tones.length === 1
          ? `At this one tone 1 % of mass moves like ${formatIn(worth, "%", 2)} of stiffness; a second tone separates them.`
          : "The drive has several tones, which separate mass from stiffness."}
      </Box>
      {likenesses.slice(0, SHOWN).map(({ name, factor, value }) => (
        <Box component="p" key={`${name} ${factor}`} maw="70ch" mt={4} c="dimmed">
          {name} moves exactly like a device with {formatIn((value - 1) * 100, "%", 1)} of {factor} alone.
        </Box>
      ))}
    </>
  );
}
