import { type PointerEvent, useMemo, useRef, useState } from "react";
import type { RecordDetail } from "../api/types";
import type { Plot } from "../picture/axes";
import { Painted } from "../picture/painted";
import type { Box, Look, Pen } from "../picture/pen";
import { formatMoment } from "../ui/format";
import { paintRecord } from "./paint-record";
import styles from "./records.module.css";

/** A shorter drag is a click, px. */
const LEAST_PX = 4;

interface RecordPlotProps {
  record: RecordDetail;
  range: [number, number];
  healthy: [number, number];
  onHealthy(stretch: [number, number]): void;
}

/** Voltage and displacement of a record; a drag over them chooses the healthy stretch. */
export function RecordPlot({ record, range, healthy, onHealthy }: RecordPlotProps) {
  const plot = useRef<Plot | undefined>(undefined);
  const begun = useRef<number | undefined>(undefined);
  const [dragged, setDragged] = useState<[number, number] | undefined>(undefined);
  const shown = dragged ?? healthy;
  const paint = useMemo(
    () => (pen: Pen, box: Box, look: Look) => {
      plot.current = paintRecord(pen, box, { record, range, healthy: shown }, look);
    },
    [record, range, shown],
  );
  const ms = (sample: number) => formatMoment(sample / record.rate_khz);

  const stretch = (from: number, to: number): [number, number] | undefined => {
    const field = plot.current?.field;
    if (!field || Math.abs(to - from) < LEAST_PX) return undefined;
    const [first, end] = [Math.min(from, to), Math.max(from, to)].map((x) => {
      const share = Math.min(Math.max((x - field.left) / (field.right - field.left), 0), 1);
      return Math.round(range[0] + share * (range[1] - range[0]));
    });
    return end > first ? [first, end] : undefined;
  };
  const place = (event: PointerEvent<HTMLElement>) => event.clientX - event.currentTarget.getBoundingClientRect().left;

  return (
    <div
      className={styles.plot}
      data-testid="record-plot"
      onPointerDown={(event) => {
        begun.current = place(event);
        event.currentTarget.setPointerCapture?.(event.pointerId);
      }}
      onPointerMove={(event) => begun.current !== undefined && setDragged(stretch(begun.current, place(event)))}
      onPointerUp={(event) => {
        const chosen = begun.current === undefined ? undefined : stretch(begun.current, place(event));
        begun.current = undefined;
        setDragged(undefined);
        if (chosen) onHealthy(chosen);
      }}
      onPointerCancel={() => {
        begun.current = undefined;
        setDragged(undefined);
      }}
    >
      <Painted
        label={`${record.name}: voltage and displacement from ${ms(range[0])} to ${ms(range[1])}; healthy from ${ms(shown[0])} to ${ms(shown[1])}`}
        paint={paint}
      />
    </div>
  );
}
