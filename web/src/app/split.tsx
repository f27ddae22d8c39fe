import { type KeyboardEvent, type PointerEvent, type ReactNode, useRef, useState } from "react";
import styles from "./split.module.css";

const KEPT = "combbench.split";
const USUAL = 45;
const [LEAST, MOST] = [15, 85];
/** The step of an arrow key, percent. */
const STEP = 5;

const within = (percent: number): number => Math.min(MOST, Math.max(LEAST, Math.round(percent)));
const kept = (): number => within(Number(localStorage.getItem(KEPT) ?? USUAL) || USUAL);

/** Two parts, one above the other, and a divider between them that is dragged; this browser remembers where it is. */
export function Split({ upper, lower }: { upper: ReactNode; lower: ReactNode }) {
  const frame = useRef<HTMLElement>(null);
  const [share, setShare] = useState(kept);
  const put = (percent: number) => {
    setShare(within(percent));
    localStorage.setItem(KEPT, String(within(percent)));
  };
  const hold = (event: PointerEvent) => event.currentTarget.setPointerCapture(event.pointerId);
  const drag = (event: PointerEvent) => {
    if (!frame.current || !event.currentTarget.hasPointerCapture(event.pointerId)) return;
    const { top, height } = frame.current.getBoundingClientRect();
    put((100 * (event.clientY - top)) / height);
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const keys: Partial<Record<string, number>> = {
      ArrowUp: share - STEP,
      ArrowDown: share + STEP,
      Home: LEAST,
      End: MOST,
    };
    const to = keys[event.key];
    if (to === undefined) return;
    event.preventDefault();
    put(to);
  };
  return (
    <main
      ref={frame}
      className={styles.split}
      style={{ gridTemplateRows: `minmax(0, ${share}fr) auto minmax(0, ${100 - share}fr)` }}
    >
      {upper}
      {/* biome-ignore lint/a11y/useSemanticElements: a thematic break cannot be dragged */}
      <div
        className={styles.divider}
        role="separator"
        tabIndex={0}
        aria-label="Height of the scope"
        aria-orientation="horizontal"
        aria-valuenow={share}
        aria-valuemin={LEAST}
        aria-valuemax={MOST}
        onPointerDown={hold}
        onPointerMove={drag}
        onKeyDown={onKeyDown}
      />
      {lower}
    </main>
  );
}
