import { type RefObject, useEffect, useRef } from "react";
import { usePanelVisible } from "../api/panel-visible";
import { useView } from "../bench/view-store";
import type { PanelFrame } from "../stream/panel-frame";
import { stream } from "../stream/stream";
import { useFeed } from "../stream/use-feed";
import type { Subscription } from "../stream/wire";
import { hover } from "../ui/hover";
import { useCanvas, useScheme } from "../ui/use-canvas";
import styles from "./painted.module.css";
import type { Box, Look } from "./pen";

const LEAST_PX = 80;
/** Words that change more often cannot be read. */
const WORDS_MS = 200;

type LivePaint = (pen: CanvasRenderingContext2D, box: Box, look: Look, tells: boolean) => void;

/** Paint a canvas in the animation loop while it is visible. The ref it returns asks for it, and so does a new painter. */
export function useLivePaint(
  { canvas, size }: ReturnType<typeof useCanvas>,
  paint: LivePaint,
  everyMs = 0,
): RefObject<boolean> {
  const scheme = useScheme();
  const fontSize = useView((s) => s.fontPx);
  const visible = usePanelVisible();
  const dirty = useRef(true);
  const painted = useRef(-Infinity);
  const told = useRef(-Infinity);
  useEffect(() => {
    if (!visible) return;
    dirty.current = true;
    return stream.loop.add(() => {
      const pen = canvas.current?.getContext("2d");
      const now = performance.now();
      if (!dirty.current || !pen || size.width < LEAST_PX || size.height === 0) return;
      if (now - painted.current < everyMs) return;
      dirty.current = false;
      painted.current = now;
      const tells = now - told.current >= WORDS_MS;
      if (tells) told.current = now;
      pen.setTransform(size.ratio, 0, 0, size.ratio, 0, 0);
      pen.clearRect(0, 0, size.width, size.height);
      paint(pen, size, { scheme, fontSize }, tells);
    });
  }, [visible, canvas, size, paint, everyMs, scheme, fontSize]);
  return dirty;
}

interface LiveCanvasProps {
  label: string;
  subscription: Subscription | undefined;
  /** Take the newest frame. */
  hear(frame: PanelFrame): void;
  /** Paint the newest frame; with `tells` the words next to it may change now. */
  paint: LivePaint;
  /** Painted at most so often, ms. */
  everyMs?: number;
}

/** A canvas that follows signals of the bench: it is painted when data have come or the pointer has moved. */
export function LiveCanvas({ label, subscription, hear, paint, everyMs }: LiveCanvasProps) {
  const place = useCanvas();
  const dirty = useLivePaint(place, paint, everyMs);
  const mark = () => {
    dirty.current = true;
  };
  useFeed(subscription, (frame) => {
    hear(frame);
    mark();
  });
  // biome-ignore lint/correctness/useExhaustiveDependencies: it only writes into a ref
  useEffect(() => hover.listen(mark), []);
  return (
    <div className={styles.live}>
      <canvas ref={place.canvas} role="img" aria-label={label} />
    </div>
  );
}
