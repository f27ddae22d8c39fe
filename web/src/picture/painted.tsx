import { useEffect, useRef, useState } from "react";
import { useView } from "../bench/view-store";
import { useCanvas, useScheme } from "../ui/use-canvas";
import styles from "./painted.module.css";
import type { Box, Look, Pen } from "./pen";

const LEAST_PX = 60;

interface PaintedProps<Shown> {
  /** The picture in words, for screen readers. */
  label: string;
  /** Returns the places of things for the pointer; a new function repaints. */
  paint(pen: Pen, box: Box, look: Look): Shown;
  /** Where the pointer is, px, or that it has left. */
  onPoint?(at: { x: number; y: number } | undefined, shown: Shown): void;
}

/** A canvas for a painter, as large as its place: in the colours and letters of the page, as sharp as the screen. */
export function Painted<Shown>({ label, paint, onPoint }: PaintedProps<Shown>) {
  const scheme = useScheme();
  const fontSize = useView((s) => s.fontPx);
  const { canvas, size } = useCanvas();
  const shown = useRef<{ value: Shown } | undefined>(undefined);
  const hasLetters = useLetters();
  // biome-ignore lint/correctness/useExhaustiveDependencies: letters that have come are painted anew
  useEffect(() => {
    const pen = canvas.current?.getContext("2d");
    if (!pen || size.width < LEAST_PX || size.height < LEAST_PX) return;
    pen.setTransform(size.ratio, 0, 0, size.ratio, 0, 0);
    pen.clearRect(0, 0, size.width, size.height);
    shown.current = { value: paint(pen, size, { scheme, fontSize }) };
  }, [canvas, size, paint, scheme, fontSize, hasLetters]);
  const point = (at: { x: number; y: number } | undefined) => shown.current && onPoint?.(at, shown.current.value);
  return (
    <div className={styles.stage}>
      <canvas
        ref={canvas}
        role="img"
        aria-label={label}
        onPointerMove={({ nativeEvent: { offsetX, offsetY } }) => point({ x: offsetX, y: offsetY })}
        onPointerLeave={() => point(undefined)}
      />
    </div>
  );
}

/** Whether the letters of the page have come: a canvas does not wait for them. */
function useLetters(): boolean {
  const [come, setCome] = useState(document.fonts.status === "loaded");
  useEffect(() => {
    let isGone = false;
    void document.fonts.ready.then(() => !isGone && setCome(true));
    return () => {
      isGone = true;
    };
  }, []);
  return come;
}
