import { type ReactNode, type Ref, useEffect, useImperativeHandle, useMemo, useRef } from "react";
import { usePanelVisible } from "../../api/panel-visible";
import { useView } from "../../bench/view-store";
import type { LegendEntry } from "../../picture/legend";
import type { Box, Look, Pen } from "../../picture/pen";
import { pictureName } from "../../picture/picture";
import type { TakePicture } from "../../picture/picture-menu";
import type { PanelFrame } from "../../stream/panel-frame";
import { stream } from "../../stream/stream";
import { useFeed } from "../../stream/use-feed";
import type { Subscription } from "../../stream/wire";
import { useCanvas, useScheme } from "../../ui/use-canvas";
import styles from "./behaviour.module.css";

/** Words that change more often cannot be read. */
const WORDS_MS = 200;

/** What a diagnoser says, as a picture and as a sentence. */
export interface Drawing {
  words: string;
  legend: readonly LegendEntry[];
  paint(pen: Pen, box: Box, look: Look): void;
}

interface BehaviourPlotProps {
  title: string;
  signals: string[];
  windowMs: number;
  columns: number;
  draw(frame: PanelFrame): Drawing | undefined;
  picture: Ref<TakePicture>;
  /** The tools, which stand before the words. */
  children: ReactNode;
}

/** The canvas of a drawing that follows the bench, and what it says in words. */
export function BehaviourPlot({ title, signals, windowMs, columns, draw, picture, children }: BehaviourPlotProps) {
  const scheme = useScheme();
  const fontSize = useView((s) => s.fontPx);
  const visible = usePanelVisible();
  const { canvas, size } = useCanvas();
  const words = useRef<HTMLParagraphElement>(null);
  const drawing = useRef<Drawing | undefined>(undefined);
  const dirty = useRef(true);
  const said = useRef(0);
  useImperativeHandle(
    picture,
    () => () => {
      const shown = drawing.current;
      return shown && { ...pictureName(title), legend: shown.legend, height: 600, paint: shown.paint };
    },
    [title],
  );

  const subscription = useMemo<Subscription>(
    () => ({ mode: "roll", signals, window_ms: windowMs, width: columns }),
    [signals, windowMs, columns],
  );
  useFeed(subscription, (frame) => {
    drawing.current = draw(frame);
    dirty.current = true;
  });

  useEffect(() => {
    if (!visible) return;
    dirty.current = true;
    return stream.loop.add(() => {
      const ctx = canvas.current?.getContext("2d");
      const shown = drawing.current;
      if (!dirty.current || !ctx || !shown || size.width < 120 || size.height < 100) return;
      dirty.current = false;
      ctx.setTransform(size.ratio, 0, 0, size.ratio, 0, 0);
      ctx.clearRect(0, 0, size.width, size.height);
      shown.paint(ctx, size, { scheme, fontSize });
      const now = performance.now();
      if (now - said.current < WORDS_MS || !words.current) return;
      said.current = now;
      words.current.textContent = shown.words;
    });
  }, [visible, canvas, size, scheme, fontSize]);

  return (
    <>
      <div className={`row ${styles.bar}`}>
        {children}
        <p ref={words} className={styles.words} data-testid="behaviour-words" />
      </div>
      <div className={styles.plot}>
        <canvas ref={canvas} className={styles.canvas} role="img" aria-label={title} />
      </div>
    </>
  );
}
