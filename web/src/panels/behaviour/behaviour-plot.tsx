import { Group, Text } from "@mantine/core";
import { type ReactNode, type RefObject, useMemo, useRef } from "react";
import type { LegendEntry } from "../../picture/legend";
import { LiveCanvas } from "../../picture/live-canvas";
import type { Box, Look, Pen } from "../../picture/pen";
import type { PanelFrame } from "../../stream/panel-frame";
import type { Subscription } from "../../stream/wire";

/** The result of a diagnoser as a picture and as a sentence. */
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
  /** Keeps the newest drawing. */
  drawing: RefObject<Drawing | undefined>;
  /** The tools, before the words. */
  children: ReactNode;
}

/** The canvas of a drawing that follows the bench, and its words. */
export function BehaviourPlot({ title, signals, windowMs, columns, draw, drawing, children }: BehaviourPlotProps) {
  const words = useRef<HTMLParagraphElement>(null);

  const subscription = useMemo<Subscription>(
    () => ({ mode: "roll", signals, window_ms: windowMs, width: columns }),
    [signals, windowMs, columns],
  );

  return (
    <>
      <Group gap="6px 8px" p="6px 12px">
        {children}
        {/* two lines are kept for a sentence, so that the drawing stays in its place */}
        <Text
          ref={words}
          fz="sm"
          c="dimmed"
          lh={1.4}
          flex="1 1 240px"
          mih="2.8em"
          style={{ alignContent: "center" }}
          data-testid="behaviour-words"
        />
      </Group>
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
