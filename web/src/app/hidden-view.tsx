import { Box, Button, Group } from "@mantine/core";
import { useMemo, useState } from "react";
import { useShallow } from "zustand/react/shallow";
import { useMay } from "../api/me";
import type { Question } from "../api/types";
import type { ViewName } from "../bench/panel-views";
import { useBench } from "../stream/bench-store";
import { scopeConfig } from "../stream/scope-config";
import { type PanelParams, servedIn, suits, VIEW } from "./panels";

/** What finds a fault by measurement alone, with the words of its button. */
const TOOLS: { view: ViewName; words: string }[] = [
  { view: "identify", words: "Frequency response" },
  { view: "spectrum", words: "Spectrum" },
  { view: "time", words: "Cursors" },
];

/** The views that layouts have in front open with a tool in their place. */
const OPENS: Partial<Record<ViewName, ViewName>> = {
  lanes: "identify",
  schematic: "identify",
  faults: "spectrum",
  view3d: "time",
};

const MEASURED = /^(sensor\.([xy]\.)?displacement|drive\.([xy]\.)?(voltage|force))$/;

/** A view whose contents are hidden: one line says so, and the tools that find the fault take its place. */
export function HiddenView({ view, question }: { view: ViewName; question: Question }) {
  const axes = useBench(useShallow((s) => s.bench?.axes));
  const signals = useBench((s) => s.bench?.signals);
  const drives = useMay("drive");
  const [wanted, open] = useState(OPENS[view]);
  const measured = useMemo(
    () =>
      scopeConfig(
        (signals ?? []).map(({ name }) => name).filter((name) => MEASURED.test(name)),
        { measure: true },
      ),
    [signals],
  );
  const [params, setParams] = useState<PanelParams>({});
  const tools = TOOLS.filter(
    (tool) =>
      servedIn(VIEW[tool.view], question) &&
      suits(VIEW[tool.view], axes && { axes }) &&
      (drives || !VIEW[tool.view].changes),
  );
  const shown = tools.find((tool) => tool.view === wanted);
  const Tool = shown && VIEW[shown.view].component;
  return (
    <section className="view" aria-label={`${VIEW[view].title}, hidden`}>
      <Group flex="none" gap="4px 6px" p="6px 10px" style={{ borderBottom: "1px solid var(--line)" }}>
        <p className="note">
          {`${VIEW[view].title}: hidden until ${question.game ? "the game is over" : "you answer"}.`}
          <span className="if-wide"> Measure instead:</span>
        </p>
        {tools.map(({ view: tool, words }) => (
          <Button
            key={tool}
            size="compact-xs"
            variant={tool === wanted ? "light" : "default"}
            aria-pressed={tool === wanted}
            onClick={() => open(tool === wanted ? undefined : tool)}
          >
            {words}
          </Button>
        ))}
      </Group>
      {Tool && (
        <Box flex={1} mih={0}>
          <Tool params={{ scope: measured, ...params }} setParams={setParams} />
        </Box>
      )}
    </section>
  );
}
