import type { KeyboardEvent, PointerEvent } from "react";
import styles from "./scope.module.css";

export interface PlotArea {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** The places of the cursors, as shares of the width. */
export type CursorPair = [number, number];

interface ScopeCursorsProps {
  area: PlotArea;
  at: CursorPair;
  /** Time at a share of the width, in words. */
  say(share: number): string;
  onMove(at: CursorPair): void;
  /** A move has ended. */
  onRest(): void;
}

const NAMES = ["A", "B"] as const;

/** Two upright lines to be dragged, or moved with the arrow keys; they stay where they are on the screen. */
export function ScopeCursors({ area, at, say, onMove, onRest }: ScopeCursorsProps) {
  const move = (which: number, share: number) => {
    const next: CursorPair = [...at];
    next[which] = Math.min(1, Math.max(0, share));
    onMove(next);
  };
  const drag = (which: number) => (event: PointerEvent<HTMLElement>) => {
    if (event.type === "pointerdown") event.currentTarget.setPointerCapture(event.pointerId);
    else if (!event.currentTarget.hasPointerCapture(event.pointerId)) return;
    const parent = event.currentTarget.parentElement?.getBoundingClientRect();
    if (parent) move(which, (event.clientX - parent.left) / parent.width);
  };
  const key = (which: number) => (event: KeyboardEvent) => {
    const step = event.shiftKey ? 0.001 : 0.01;
    if (event.key === "ArrowLeft") move(which, at[which] - step);
    else if (event.key === "ArrowRight") move(which, at[which] + step);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return (
    <div className={styles.cursors} style={area}>
      {NAMES.map((name, which) => (
        <div
          key={name}
          className={styles.cursor}
          style={{ left: `${at[which] * 100}%` }}
          role="slider"
          tabIndex={0}
          aria-label={`Cursor ${name}`}
          aria-valuemin={0}
          aria-valuemax={100}
          aria-valuenow={Math.round(at[which] * 100)}
          aria-valuetext={say(at[which])}
          onPointerDown={drag(which)}
          onPointerMove={drag(which)}
          onPointerUp={onRest}
          onKeyDown={key(which)}
          onKeyUp={onRest}
        >
          <b>{name}</b>
        </div>
      ))}
    </div>
  );
}
