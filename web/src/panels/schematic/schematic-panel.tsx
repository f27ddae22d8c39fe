import { Box, Group, NativeSelect } from "@mantine/core";
import { useMemo, useState } from "react";
import { useShallow } from "zustand/react/shallow";
import type { Document } from "../../api/types";
import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatShort } from "../../ui/format";
import { parameterValue, useInstances } from "../card/instances";
import { AxesLoop } from "./axes-loop";
import { InsideDrawing } from "./inside-drawing";
import { ResonatorLoop } from "./resonator-loop";
import { type Structure, structureOf } from "./structure";
import { useActingFaults } from "./use-live-values";

const LOOP = "";
const PADDING = "6px 8px 4px";
/** Families whose blocks are drawn from inside too. */
const OPENED = ["control", "identify", "diagnose"];

/** The supervisor that stops the board, and changes no controller. */
const SHUTDOWN = "shutdown";

/** The loop with its values now, or the inside of a controller, an identifier or a diagnoser. */
export function SchematicPanel() {
  const axes = useBench((s) => s.bench?.axes);
  const slots = useBench(useShallow((s) => s.bench?.slots));
  const controller = useBench((s) => s.bench?.controller);
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const rate = useBench((s) => s.bench?.sample_rate_khz);
  const structure = useStructure();
  const acting = useActingFaults();
  const list = useInstances();
  const { block } = useCatalog();
  const [wanted, setWanted] = useState(LOOP);
  const opened = list.filter((one) => OPENED.includes(one.family));
  const instance = opened.find((one) => one.id === wanted);
  const card = instance && block(instance.family, instance.name);
  if (!axes || !slots || !controller || !diagnosers)
    return <EmptyState title="No bench yet">The loop appears with the bench.</EmptyState>;
  const isFlat = axes.length === 0;
  const choice = (
    <NativeSelect
      maw="100%"
      ml="auto"
      aria-label="Drawing"
      value={instance ? wanted : LOOP}
      data={[
        { value: LOOP, label: "The loop" },
        ...opened.map(({ id, title, family, name }) => ({
          value: id,
          label: `${title}: ${block(family, name)?.title ?? name.replaceAll("_", " ")}`,
        })),
      ]}
      onChange={(e) => setWanted(e.currentTarget.value)}
    />
  );
  if (instance && card)
    return (
      <Box component="section" className="view" p={PADDING} aria-label={`Inside: ${card.title}`}>
        <InsideDrawing key={`${instance.id} ${instance.name}`} instance={instance} block={card} />
        {choice}
      </Box>
    );
  return (
    <Box component="section" className="view" p={PADDING} aria-label="Diagram">
      {isFlat ? (
        <ResonatorLoop controller={controller} diagnosers={diagnosers} structure={structure} />
      ) : (
        <AxesLoop axes={axes} slots={slots} />
      )}
      <Group justify="space-between" gap="4px 8px">
        <Box component="p" className="remark" m="0 4px">
          {rate === undefined ? "" : formatShort(rate, "kHz")}
          {isFlat && structure.figure && ` · drawn as figure ${structure.figure}`}
          {isFlat && !structure.hasRoom && acting.length > 0 && (
            <Box component="span" c="var(--alarm)" fw={650}>
              {" "}
              · {acting.map((fault) => fault.title).join(", ")}
            </Box>
          )}
        </Box>
        {choice}
      </Group>
    </Box>
  );
}

/** How the loop of the bench is drawn now. */
function useStructure(): Structure {
  const parameters = useBench((s) => s.bench?.parameters);
  const controller = useBench((s) => s.bench?.controller) ?? "";
  const hasDiagnoser = useBench((s) => Object.keys(s.bench?.diagnosers ?? {}).length > 0);
  const list = useInstances();
  return useMemo(() => {
    const document: Document = parameters ?? {};
    const value = (id: string, name: string) => {
      const instance = list.find((i) => i.id === id);
      return instance && parameterValue(document, instance, name);
    };
    return structureOf({
      controller,
      augments: value(`controllers.${controller}`, "augment") !== false,
      sensor: list.find((i) => i.id === "sensor")?.name ?? "",
      light: String(value("sensor", "light") ?? "through_wafer"),
      hasDiagnoser,
      hasIdentifier: list.some((i) => i.family === "identify"),
      isSupervised: list.some((i) => i.family === "supervise" && i.name !== SHUTDOWN),
    });
  }, [parameters, controller, hasDiagnoser, list]);
}
