import { useCallback, useEffect, useMemo, useRef } from "react";
import { useLivePaint } from "../../picture/live-canvas";
import type { Box, Look, Pen } from "../../picture/pen";
import { useBench } from "../../stream/bench-store";
import type { PanelFrame } from "../../stream/panel-frame";
import { scopeConfig } from "../../stream/scope-config";
import { stream } from "../../stream/stream";
import { useFeed } from "../../stream/use-feed";
import { hover } from "../../ui/hover";
import { useCanvas } from "../../ui/use-canvas";
import { listenForGestures } from "../scope/scope-gestures";
import { scopeSubscription } from "../scope/use-time-view";
import styles from "./lanes.module.css";
import type { LaneTime } from "./use-lane-time";

/** A frame of device time, the ticks of it that are seen, and of these the one under the pointer. */
export interface LaneShown {
  frame: PanelFrame;
  span: { start: number; end: number };
  hover: number | undefined;
}

interface LaneCanvasProps {
  label: string;
  /** An explanation of the names at the left. */
  legend?: string;
  signals: string[];
  time: LaneTime;
  /** CSS pixels left free beside the field of time. */
  left: number;
  right: number;
  /** A new function paints anew. */
  paint(pen: Pen, box: Box, shown: LaneShown, look: Look): void;
  /** A sample was clicked. */
  onPick?(tick: number): void;
}

/** Signals over time on a canvas that shares its window with others: it pans, zooms, and reports clicks. */
export function LaneCanvas({ label, legend, signals, time, left, right, paint, onPick }: LaneCanvasProps) {
  const dtMs = useBench((s) => s.bench?.dt_ms);
  const over = useRef<HTMLDivElement>(null);
  const frame = useRef<PanelFrame | undefined>(undefined);
  const shown = useRef({ start: 0, end: 1 });
  const pick = useRef(onPick);
  pick.current = onPick;
  const whole = useRef(time.whole);
  whole.current = time.whole;
  const place = useCanvas();
  const { canvas, size } = place;
  const paintShown = useCallback(
    (pen: Pen, box: Box, look: Look) => {
      if (!frame.current) return;
      const { start, end } = shown.current;
      const inSight = hover.tick !== undefined && hover.tick >= start && hover.tick < end ? hover.tick : undefined;
      paint(pen, box, { frame: frame.current, span: shown.current, hover: inSight }, look);
    },
    [paint],
  );
  const dirty = useLivePaint(place, paintShown);
  const { windowMs, view } = time;

  const subscription = useMemo(() => {
    const pixels = size.width - left - right;
    if (!dtMs || pixels < 40) return undefined;
    return scopeSubscription(scopeConfig(signals, { windowMs }), view, pixels, dtMs);
  }, [signals, dtMs, size, left, right, windowMs, view]);

  useFeed(subscription, (picture) => {
    const held = time.held();
    if (picture.frozen !== (held !== undefined)) return;
    frame.current = picture;
    shown.current = held ?? whole.current ?? { start: picture.startTick, end: picture.endTick };
    dirty.current = true;
  });

  useEffect(() => {
    const moved = () => {
      shown.current = time.held() ?? time.whole ?? shown.current;
      dirty.current = true;
    };
    const stops = [time.listen(moved), hover.listen(moved)];
    return () => {
      for (const stop of stops) stop();
    };
  }, [time, dirty]);

  useEffect(() => {
    if (!over.current) return;
    return listenForGestures(
      over.current,
      { onSpan: time.look, onLive: time.goLive, onClick: (tick) => pick.current?.(Math.floor(tick)) },
      () => shown.current,
    );
  }, [time]);

  const point = (offset: number | undefined) => {
    const width = over.current?.clientWidth ?? 1;
    const { start, end } = shown.current;
    hover.set(offset === undefined ? undefined : start + (offset / width) * (end - start));
  };

  return (
    <div className={styles.plot}>
      <canvas ref={canvas} className={styles.canvas} role="img" aria-label={label} />
      {legend && <div className={styles.legend} style={{ width: left }} title={legend} />}
      <div
        ref={over}
        className={styles.over}
        style={{ left, right }}
        onPointerMove={(e) => point(e.nativeEvent.offsetX)}
        onPointerLeave={() => point(undefined)}
      />
      {right > 0 && onPick && (
        <button
          type="button"
          className={styles.newest}
          style={{ width: right }}
          aria-label="Explain the newest sample"
          title="Explain the newest sample, whose figures these are"
          onClick={() => onPick(stream.client.head.tick - 1)}
        />
      )}
    </div>
  );
}
