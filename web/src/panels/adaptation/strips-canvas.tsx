import { type RefObject, useMemo } from "react";
import { useView } from "../../bench/view-store";
import type { Box, Look, Pen } from "../../picture/pen";
import { LaneCanvas, type LaneShown } from "../lanes/lane-canvas";
import type { LaneTime } from "../lanes/use-lane-time";
import { type Strip, signalsOf } from "./adaptation-strips";
import { AXIS_PX, gutter, paintStrips, RIGHT_PX } from "./paint-strips";

interface StripsCanvasProps {
  label: string;
  strips: readonly Strip[];
  /** Height of a strip, px. */
  each: number;
  time: LaneTime;
  /** Keeps the newest picture. */
  shown: RefObject<LaneShown | undefined>;
}

/** Strips of signals over time, one under the other. */
export function StripsCanvas({ label, strips, each, time, shown }: StripsCanvasProps) {
  const fontSize = useView((s) => s.fontPx);
  const signals = useMemo(() => strips.flatMap(signalsOf), [strips]);
  const paint = useMemo(
    () => (pen: Pen, box: Box, now: LaneShown, look: Look) => {
      shown.current = now;
      paintStrips(pen, box, now, strips, look);
    },
    [strips, shown],
  );
  return (
    <div style={{ display: "flex", flex: "none", height: strips.length * each + AXIS_PX, padding: "0 4px" }}>
      <LaneCanvas
        label={`${label}: ${strips.map((s) => s.title).join(", ")} over time`}
        signals={signals}
        time={time}
        left={gutter(fontSize)}
        right={RIGHT_PX}
        paint={paint}
      />
    </div>
  );
}
