import { Box, Button, Group, NativeSelect } from "@mantine/core";
import { useMemo, useRef, useState } from "react";
import { useMay } from "../../api/me";
import type { BlockCard, Document } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { actions } from "../../bench/actions";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { TRACE_COLOURS } from "../../ui/palette";
import { TraceSwatch } from "../../ui/trace-swatch";
import { useScheme } from "../../ui/use-canvas";
import type { LaneShown } from "../lanes/lane-canvas";
import { LaneTools } from "../lanes/lane-tools";
import { useLaneTime } from "../lanes/use-lane-time";
import { adaptiveUnits } from "./adaptation-strips";
import { ExcitationMeter } from "./excitation-meter";
import { STRIP_PX, stripsPicture } from "./paint-strips";
import { StripsCanvas } from "./strips-canvas";

const LEGEND = [{ name: "now", slot: 1 }];

/** Adapted quantities and their ideal values: gains, V and its derivative, s, errors, and the excitation by the input. */
export function AdaptationPanel() {
  const signals = useBench((s) => s.bench?.signals);
  const controller = useBench((s) => s.bench?.controller);
  const controllers = useBench((s) => s.bench?.controllers);
  const parameters = useBench((s) => s.bench?.parameters);
  const dtMs = useBench((s) => s.bench?.dt_ms);
  const { blocks } = useCatalog();
  const colours = TRACE_COLOURS[useScheme()];
  const [windowMs, setWindowMs] = useState(20);
  const [wanted, setWanted] = useState<string | undefined>(undefined);
  const time = useLaneTime(windowMs, dtMs);
  const units = useMemo(
    () => adaptiveUnits(signals ?? [], layersOf(parameters, blocks)),
    [signals, parameters, blocks],
  );
  const unit =
    units.find((u) => u.block === wanted) ??
    units.find((u) => u.block === controller) ??
    units.find((u) => controllers?.includes(u.block)) ??
    units[0];
  const shown = useRef<LaneShown | undefined>(undefined);
  if (!unit)
    return (
      <EmptyState title="Nothing adapts on this bench">
        Its controllers have fixed gains and it has no identifier. Gains, their ideal values and Lyapunov's function
        appear here with the next bench that has one.
      </EmptyState>
    );
  const take = () =>
    shown.current &&
    stripsPicture(shown.current, unit.strips, `Adaptation of ${unit.block.replaceAll("_", " ")}`, LEGEND);
  return (
    <Box component="section" className="view" fz="sm" aria-label="Adaptation">
      <Group gap="4px 8px" pos="sticky" top={0} p="6px 8px 4px 12px" bg="var(--panel)" style={{ zIndex: 1 }}>
        <NativeSelect
          aria-label="What adapts"
          value={unit.block}
          data={units.map((u) => ({
            value: u.block,
            label: `${u.block.replaceAll("_", " ")}${u.block === controller ? ", drives" : ""}`,
          }))}
          onChange={(e) => setWanted(e.currentTarget.value)}
        />
        <Group gap={6} wrap="nowrap" flex={1} pl={8} c="dimmed" fz="xs">
          <TraceSwatch colour={colours[1]} dash={0} /> now <TraceSwatch colour={colours[0]} dash={1} /> ideal
        </Group>
        <LaneTools time={time} onWindow={setWindowMs} take={take} />
      </Group>
      <ExcitationMeter />
      {unit.block !== controller && <Shadow block={unit.block} />}
      <StripsCanvas label={unit.block} strips={unit.strips} each={STRIP_PX} time={time} shown={shown} />
    </Box>
  );
}

/** A controller that adapts in the shadow of another may be given the drive. */
function Shadow({ block }: { block: string }) {
  const controllers = useBench((s) => s.bench?.controllers);
  const drives = useMay("drive");
  if (!controllers?.includes(block)) return null;
  return (
    <Box component="p" c="dimmed" p="2px 12px 6px">
      {block.replaceAll("_", " ")} runs in shadow: it adapts to the voltage another applies.{" "}
      {drives && (
        <Button size="compact-xs" variant="light" onClick={() => actions.controller(block)}>
          Give it the drive
        </Button>
      )}
    </Box>
  );
}

/** Boundary layers by controller: as set, or as the catalogue has them. */
function layersOf(parameters: Document | undefined, blocks: readonly BlockCard[]): Record<string, number> {
  const own = (parameters?.controllers ?? {}) as Record<string, { layer_um?: number }>;
  return Object.fromEntries(
    blocks.flatMap((b) => {
      const usual = b.family === "control" && b.parameters.find((p) => p.name === "layer_um")?.default;
      return typeof usual === "number" ? [[b.name, own[b.name]?.layer_um ?? usual]] : [];
    }),
  );
}
