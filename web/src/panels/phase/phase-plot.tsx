import { type Ref, useEffect, useImperativeHandle, useMemo, useRef } from "react";
import { usePanelVisible } from "../../api/panel-visible";
import type { UnstableRegion } from "../../api/types";
import { useView } from "../../bench/view-store";
import type { TakePicture } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import { middles } from "../../stream/panel-frame";
import { stream } from "../../stream/stream";
import { useFeed } from "../../stream/use-feed";
import type { Subscription } from "../../stream/wire";
import { hover } from "../../ui/hover";
import { unitScale } from "../../ui/unit-scale";
import { useCanvas, useScheme } from "../../ui/use-canvas";
import { useTraces } from "../scope/use-traces";
import { type PhaseShown, paintPhase, phasePicture } from "./paint-phase";
import styles from "./phase.module.css";
import { extent, follow, type Range, union } from "./phase-range";
import { mapExtent } from "./unstable-map";

const MOST_COLUMNS = 4096;

interface PhasePlotProps {
  x: string;
  y: string;
  windowMs: number;
  map: UnstableRegion | undefined;
  fits: { folds: boolean; boundary: boolean };
  picture: Ref<TakePicture>;
}

/** The canvas of a phase plane: every tick of the window is a point. */
export function PhasePlot({ x, y, windowMs, map, fits, picture }: PhasePlotProps) {
  const scheme = useScheme();
  const fontSize = useView((s) => s.fontPx);
  const visible = usePanelVisible();
  const dtMs = useBench((s) => s.bench?.dt_ms);
  const names = useMemo(() => (x === y ? [x] : [x, y]), [x, y]);
  const traces = useTraces(names);
  const { canvas, size } = useCanvas();
  const points = useRef({ x: new Float32Array(0), y: new Float32Array(0) });
  const ranges = useRef<{ x: Range | undefined; y: Range | undefined }>({ x: undefined, y: undefined });
  const shown = useRef<{ start: number; end: number } | undefined>(undefined);
  const dirty = useRef(true);
  const painted = useRef<PhaseShown | undefined>(undefined);
  useImperativeHandle(picture, () => () => painted.current && phasePicture(painted.current), []);

  const subscription = useMemo<Subscription | undefined>(() => {
    if (!dtMs) return undefined;
    const width = Math.max(2, Math.min(MOST_COLUMNS, Math.round(windowMs / dtMs)));
    return { mode: "roll", signals: names, window_ms: windowMs, width };
  }, [names, windowMs, dtMs]);

  useFeed(subscription, (frame) => {
    shown.current = { start: frame.startTick, end: frame.endTick };
    points.current = { x: middles(frame, 0), y: middles(frame, frame.signals - 1) };
    dirty.current = true;
  });

  // biome-ignore lint/correctness/useExhaustiveDependencies: other signals or another map begin with other axes
  useEffect(() => {
    ranges.current = { x: undefined, y: undefined };
    dirty.current = true;
  }, [x, y, map]);

  useEffect(
    () =>
      hover.listen(() => {
        dirty.current = true;
      }),
    [],
  );

  useEffect(() => {
    if (!visible) return;
    dirty.current = true;
    return stream.loop.add(() => {
      const ctx = canvas.current?.getContext("2d");
      if (!dirty.current || !ctx || size.width < 80 || size.height < 80 || traces.length === 0) return;
      dirty.current = false;
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
      ctx.setTransform(size.ratio, 0, 0, size.ratio, 0, 0);
      ctx.clearRect(0, 0, size.width, size.height);
      painted.current = {
        x: { range: across, scale: unitScale(first.unit, largest(across)), name: words(first.name) },
        y: { range: up, scale: unitScale(second.unit, largest(up)), name: words(second.name) },
        points: points.current,
        hovered: hoveredColumn(shown.current, points.current.x.length),
        map,
        fits,
        slot: second.name.endsWith("velocity") ? first.slot : second.slot,
      };
      paintPhase(ctx, size, painted.current, { scheme, fontSize });
    });
  }, [visible, canvas, size, traces, map, fits.folds, fits.boundary, scheme, fontSize, fits]);

  return (
    <div className={styles.plot}>
      <canvas
        ref={canvas}
        className={styles.canvas}
        role="img"
        aria-label={`${words(y)} over ${words(x)}${map ? ", over the map of the unstable region" : ""}`}
      />
    </div>
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
