import { Box, Group } from "@mantine/core";
import { useMemo, useRef, useState } from "react";
import { useMay } from "../../api/me";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { stripsPicture } from "../adaptation/paint-strips";
import { StripsCanvas } from "../adaptation/strips-canvas";
import type { LaneShown } from "../lanes/lane-canvas";
import { LaneTools } from "../lanes/lane-tools";
import { useLaneTime } from "../lanes/use-lane-time";
import { boardsOf, comparedOn, comparison } from "./boards";
import { TwinFigures } from "./twin-figures";
import { TwinsForm } from "./twins-form";

const EACH_PX = 92;

/** The same device, noise and faults under different controllers: tracking, effort and gains over one another. */
export function TwinsPanel() {
  const id = useBench((s) => s.bench?.id);
  const parameters = useBench((s) => s.bench?.parameters);
  const controller = useBench((s) => s.bench?.controller);
  const signals = useBench((s) => s.bench?.signals);
  const axes = useBench((s) => s.bench?.axes);
  const dtMs = useBench((s) => s.bench?.dt_ms);
  const [windowMs, setWindowMs] = useState(4);
  const teaches = useMay("teach");
  const time = useLaneTime(windowMs, dtMs);
  const boards = useMemo(
    () => (parameters && controller ? boardsOf({ parameters, controller }) : []),
    [parameters, controller],
  );
  const compared = useMemo(() => comparedOn(axes ?? []), [axes]);
  const strips = useMemo(
    () => (boards.length > 1 ? comparison(boards, compared, signals ?? []) : []),
    [boards, compared, signals],
  );
  const shown = useRef<LaneShown | undefined>(undefined);
  if (!id || boards.length === 0) return <EmptyState title="No bench yet">Twins begin with a bench.</EmptyState>;
  const form = teaches && <TwinsForm key={id} chosen={boards.slice(1).map((b) => b.chosen)} />;
  if (boards.length === 1)
    return (
      <EmptyState title="No twins on this bench" action={form}>
        A twin is a second board that meets the same input, noise and faults, tick by tick, under another controller.{" "}
        {teaches
          ? "Choose up to three; the bench restarts with them at tick 0."
          : "Only the teacher gives a bench twins; scenarios of the gallery have some."}
      </EmptyState>
    );
  const take = () => shown.current && stripsPicture(shown.current, strips, "Twins", boards);
  return (
    <Box component="section" className="view" fz="sm" aria-label="Twins">
      <Group gap="4px 8px" pos="sticky" top={0} p="6px 8px 4px 12px" bg="var(--panel)" style={{ zIndex: 1 }}>
        {form}
        <LaneTools time={time} onWindow={setWindowMs} take={take} />
      </Group>
      <TwinFigures boards={boards} compared={compared} />
      <StripsCanvas
        label={boards.map((b) => b.name).join(", ")}
        strips={strips}
        each={EACH_PX}
        time={time}
        shown={shown}
      />
    </Box>
  );
}
