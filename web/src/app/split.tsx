import { useLocalStorage, useSplitter } from "@mantine/hooks";
import type { ReactNode } from "react";
import { storageName } from "../api/storage-name";
import styles from "./split.module.css";

const KEPT = storageName("combbench.split");
const USUAL = 45;
const [LEAST, MOST] = [15, 85];
/** The step of an arrow key, percent. */
const STEP = 5;

/** Two parts, one above the other, and a divider between them that is dragged; this browser remembers its place. */
export function Split({ upper, lower }: { upper: ReactNode; lower: ReactNode }) {
  const [kept, keep] = useLocalStorage({ key: KEPT, defaultValue: USUAL, getInitialValueInEffect: false });
  const share = Math.min(MOST, Math.max(LEAST, Math.round(kept)));
  const { ref, getHandleProps } = useSplitter({
    orientation: "vertical",
    panels: [
      { defaultSize: USUAL, min: LEAST, max: MOST },
      { defaultSize: 100 - USUAL, min: 100 - MOST },
    ],
    sizes: [share, 100 - share],
    onSizeChange: ([size]) => keep(Math.round(Number(size))),
    step: STEP,
    resetOnDoubleClick: false,
  });
  const handle = {
    ...getHandleProps({ index: 0 }),
    "aria-label": "Height of the scope",
    "aria-orientation": "horizontal" as const,
  };
  return (
    <main
      ref={ref}
      className={styles.split}
      style={{ gridTemplateRows: `minmax(0, ${share}fr) auto minmax(0, ${100 - share}fr)` }}
    >
      {upper}
      <div className={styles.divider} {...handle} />
      {lower}
    </main>
  );
}
