import { useMemo, useRef, useState } from "react";
import { useMay } from "../../api/me";
import { useView } from "../../bench/view-store";
import type { Box, Look, Pen } from "../../picture/pen";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { signalsOf } from "../adaptation/adaptation-strips";
import { AXIS_PX, gutter, paintStrips, RIGHT_PX, stripsPicture } from "../adaptation/paint-strips";
import { LaneCanvas, type LaneShown } from "../lanes/lane-canvas";
import { LaneTools } from "../lanes/lane-tools";
import { useLaneTime } from "../lanes/use-lane-time";
import { boardsOf, comparedOn, comparison } from "./boards";
import { TwinFigures } from "./twin-figures";
import styles from "./twins.module.css";
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
  const fontSize = useView((s) => s.fontPx);
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
  const names = useMemo(() => strips.flatMap(signalsOf), [strips]);
  const shown = useRef<LaneShown | undefined>(undefined);
  const paint = useMemo(
    () => (pen: Pen, box: Box, now: LaneShown, look: Look) => {
      shown.current = now;
      paintStrips(pen, box, now, strips, look);
    },
    [strips],
  );
  if (!id || boards.length === 0) return <EmptyState title="No bench yet">Twins begin with a bench.</EmptyState>;
  const form = teaches && <TwinsForm key={id} chosen={boards.slice(1).map((b) => b.chosen)} />;
  if (boards.length === 1)
    return (
      <EmptyState title="No twins on this bench" action={form}>
        A twin is a second board that meets the same input, noise and faults, tick by tick, under another controller.{" "}
        {teaches
          ? "Choose up to three; the bench restarts at tick 0 with them beside it."
          : "Only the teacher gives a bench twins; scenarios of the gallery have some."}
      </EmptyState>
    );
  const take = () => shown.current && stripsPicture(shown.current, strips, "Twins", boards);
  return (
    <section className={`view ${styles.panel}`} aria-label="Twins">
      <div className={`row ${styles.bar}`}>
        {form}
        <LaneTools time={time} onWindow={setWindowMs} take={take} />
      </div>
      <TwinFigures boards={boards} compared={compared} />
      <div className={styles.strips} style={{ height: strips.length * EACH_PX + AXIS_PX }}>
        <LaneCanvas
          label={`${boards.map((b) => b.name).join(", ")}: ${strips.map((s) => s.title).join(", ")} over time`}
          signals={names}
          time={time}
          left={gutter(fontSize)}
          right={RIGHT_PX}
          paint={paint}
        />
      </div>
    </section>
  );
}
