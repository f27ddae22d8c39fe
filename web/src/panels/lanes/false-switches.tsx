import { Box } from "@mantine/core";
import type { Score } from "../../api/types";
import { useBench } from "../../stream/bench-store";
import { formatCount, formatMoment, formatNumber, formatSi, formatTick } from "../../ui/format";

/** How often a diagnoser left the right verdict while the device stayed as it was: when last, and for how long. */
export function FalseSwitches({ score }: { score: Score }) {
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const { false_switches: count, last_false_switches: known = [] } = score;
  const last = known.at(-1);
  const at = (tick: number) => `at ${formatMoment(tick * dtMs)}`;
  const told = known.map(
    ({ tick, samples }) =>
      `${at(tick)} (${formatTick(tick)}) for ${formatCount(samples, "sample")}, ${formatSi(samples * dtMs, "ms", 3)}`,
  );
  if (count > told.length) told.unshift(`${formatNumber(count - told.length, 0)} earlier`);
  return (
    <span title={last && ["The right verdict was left though nothing changed:", ...told].join("\n")}>
      {formatNumber(count, 0)}
      {last && (
        <Box component="small" ml={6}>
          last {at(last.tick)}, {formatCount(last.samples, "sample")}
        </Box>
      )}
    </span>
  );
}
