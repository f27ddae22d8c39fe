import { Group, Box as Place } from "@mantine/core";
import { type ReactNode, useState } from "react";
import type { Scheme } from "../ui/palette";
import { useScheme } from "../ui/use-canvas";
import styles from "./figure.module.css";
import type { LegendEntry } from "./legend";
import { Legend } from "./legend-list";
import { Painted } from "./painted";
import type { Box, Look, Pen } from "./pen";
import { fileStem } from "./picture";
import { PictureMenu } from "./picture-menu";

interface FigureProps<Shown> {
  title: string;
  /** The picture in words, for screen readers. */
  label: string;
  /** Of the plot, px. */
  height: number;
  paint(pen: Pen, box: Box, look: Look): Shown;
  /** The reading at a place, px. */
  read(at: { x: number; y: number }, shown: Shown): string | undefined;
  legend?(scheme: Scheme): LegendEntry[];
  children?: ReactNode;
}

/** A painted figure under its title, which the pointer reads and which is kept as a file. */
export function Figure<Shown>({ title, label, height, paint, read, legend, children }: FigureProps<Shown>) {
  const scheme = useScheme();
  const [text, setText] = useState<string | undefined>(undefined);
  const take = () => ({ title, stem: fileStem(title), height: 1.5 * height, legend: legend?.("light"), paint });
  return (
    <figure className={`column ${styles.figure}`}>
      <Group component="figcaption" gap={12} wrap="nowrap" align="start" fz="sm" fw={600}>
        {title}
        <Place component="output" className="cut" flex={1} c="dimmed" fw={450} ta="right">
          {text}
        </Place>
        <PictureMenu name={title} take={take} />
      </Group>
      <div style={{ height }}>
        <Painted label={label} paint={paint} onPoint={(at, shown) => setText(at && read(at, shown))} />
      </div>
      {legend && <Legend entries={legend(scheme)} />}
      {children}
    </figure>
  );
}
