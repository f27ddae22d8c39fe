import { type ReactNode, type Ref, useImperativeHandle, useMemo, useRef } from "react";
import type { LegendEntry } from "../../picture/legend";
import { LiveCanvas } from "../../picture/live-canvas";
import type { Box, Look, Pen } from "../../picture/pen";
import { pictureName } from "../../picture/picture";
import type { TakePicture } from "../../picture/picture-menu";
import type { PanelFrame } from "../../stream/panel-frame";
import type { Subscription } from "../../stream/wire";
import styles from "./behaviour.module.css";

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
  const words = useRef<HTMLParagraphElement>(null);
  const drawing = useRef<Drawing | undefined>(undefined);
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

  return (
    <>
      <div className={`row ${styles.bar}`}>
        {children}
        <p ref={words} className={styles.words} data-testid="behaviour-words" />
      </div>
      <LiveCanvas
        label={title}
        subscription={subscription}
        hear={(frame) => {
          drawing.current = draw(frame);
        }}
        paint={(pen, box, look, tells) => {
          drawing.current?.paint(pen, box, look);
          if (tells && words.current && drawing.current) words.current.textContent = drawing.current.words;
        }}
      />
    </>
  );
}
