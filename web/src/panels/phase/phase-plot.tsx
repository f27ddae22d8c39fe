import { type RefObject, useEffect, useMemo, useRef } from "react";
import type { UnstableRegion } from "../../api/types";
import { LiveCanvas } from "../../picture/live-canvas";
import { middles } from "../../stream/panel-frame";
import { hover } from "../../ui/hover";
import { unitScale } from "../../ui/unit-scale";
import { useTraces } from "../scope/use-traces";
import { type PhaseShown, paintPhase } from "./paint-phase";
import { extent, follow, type Range, union } from "./phase-range";
import { mapExtent } from "./unstable-map";
import { useTicks } from "./use-ticks";

interface PhasePlotProps {
  x: string;
  y: string;
  windowMs: number;
  map: UnstableRegion | undefined;
  fits: { folds: boolean; boundary: boolean };
  /** Keeps the newest picture. */
  painted: RefObject<PhaseShown | undefined>;
}

/** The canvas of a phase plane: every tick of the window is a point. */
export function PhasePlot({ x, y, windowMs, map, fits, painted }: PhasePlotProps) {
  const names = useMemo(() => (x === y ? [x] : [x, y]), [x, y]);
  const traces = useTraces(names);
  const points = useRef({ x: new Float32Array(0), y: new Float32Array(0) });
  const ranges = useRef<{ x: Range | undefined; y: Range | undefined }>({ x: undefined, y: undefined });
  const shown = useRef<{ start: number; end: number } | undefined>(undefined);

  const subscription = useTicks(names, windowMs);

  // biome-ignore lint/correctness/useExhaustiveDependencies: other signals or another map begin with other axes
  useEffect(() => {
    ranges.current = { x: undefined, y: undefined };
  }, [x, y, map]);

  return (
    <LiveCanvas
      label={`${words(y)} over ${words(x)}${map ? ", over the map of the unstable region" : ""}`}
      subscription={subscription}
      hear={(frame) => {
        shown.current = { start: frame.startTick, end: frame.endTick };
        points.current = { x: middles(frame, 0), y: middles(frame, frame.signals - 1) };
      }}
      paint={(pen, box, look) => {
        if (traces.length === 0) return;
        const axis = (name: "x" | "y", shown: boolean) => {
          const held = shown ? mapExtent(map, name) : undefined;
          const seen = extent(points.current[name]) ?? held ?? [-1, 1];
          const range = follow(ranges.current[name], union(seen as Range, held));
          ranges.current[name] = range;
          return range;
        };
        const first = traces[0];
        const second = traces[traces.length - 1];
        const across = axis("x", fits.folds);
        const up = axis("y", fits.boundary);
        painted.current = {
          x: { range: across, scale: unitScale(first.unit, largest(across)), name: words(first.name) },
          y: { range: up, scale: unitScale(second.unit, largest(up)), name: words(second.name) },
          points: points.current,
          hovered: hoveredColumn(shown.current, points.current.x.length),
          map,
          fits,
          slot: second.name.endsWith("velocity") ? first.slot : second.slot,
        };
        paintPhase(pen, box, painted.current, look);
      }}
    />
  );
}

const largest = ([low, high]: Range) => Math.max(Math.abs(low), Math.abs(high));
const words = (name: string) => name.replaceAll("_", " ").replace(".", " ");

/** The column of the tick under the pointer of any panel, if this one shows it. */
function hoveredColumn(span: { start: number; end: number } | undefined, columns: number): number | undefined {
  if (!span || hover.tick === undefined) return undefined;
  const at = Math.floor(((hover.tick - span.start) / (span.end - span.start)) * columns);
  return at >= 0 && at < columns ? at : undefined;
}
