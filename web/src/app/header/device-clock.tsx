import { useEffect, useRef } from "react";
import { useBench } from "../../stream/bench-store";
import { stream } from "../../stream/stream";
import { formatClock, formatTick } from "../../ui/format";
import styles from "./header.module.css";

/** Device time and tick, straight from the frames. */
export function DeviceClock() {
  const time = useRef<HTMLSpanElement>(null);
  const tickText = useRef<HTMLElement>(null);
  useEffect(
    () =>
      stream.loop.add(() => {
        const { bench } = useBench.getState();
        const head = stream.client.head;
        const dt = head.dtMs || bench?.dt_ms || 0;
        // Without a panel that streams there are no frames; the status is a little behind but never still.
        const framed = bench?.state === "running" && stream.client.feeds.size > 0;
        const tick = Math.max(head.dtMs ? head.tick : 0, framed ? 0 : (bench?.tick ?? 0));
        const text = formatClock(tick * dt);
        if (time.current && time.current.textContent !== text) time.current.textContent = text;
        const ticks = formatTick(tick);
        if (tickText.current && tickText.current.textContent !== ticks) tickText.current.textContent = ticks;
      }),
    [],
  );
  return (
    <div className={styles.clock} role="timer" aria-label="Device time" aria-live="off">
      <div>
        <span ref={time}>0.000 000</span> s
      </div>
      <small ref={tickText}>tick 0</small>
    </div>
  );
}
