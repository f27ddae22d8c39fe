import { IconX } from "@tabler/icons-react";
import { type RefObject, useEffect, useRef } from "react";
import { stream } from "../../stream/stream";
import { formatOn, formatSi } from "../../ui/format";
import { SignalName } from "../../ui/signal-name";
import { TraceSwatch } from "../../ui/trace-swatch";
import styles from "./scope.module.css";
import type { PlotTrace } from "./scope-options";
import type { ScopePlot } from "./scope-plot";

const EVERY_MS = 90;

interface ScopeLegendProps {
  traces: PlotTrace[];
  plot: RefObject<ScopePlot | undefined>;
  onRemove(name: string): void;
}

/** Names and values; the values follow the hovered time, or the newest sample. */
export function ScopeLegend({ traces, plot, onRemove }: ScopeLegendProps) {
  const values = useRef<(HTMLElement | null)[]>([]);

  useEffect(() => {
    let last = 0;
    return stream.loop.add(() => {
      const now = performance.now();
      if (now - last < EVERY_MS || !plot.current) return;
      last = now;
      const shown = plot.current;
      traces.forEach((trace, i) => {
        const element = values.current[i];
        if (!element) return;
        const scale = shown.scaleOf(trace.unit);
        const value = shown.reading(i);
        const text = scale ? formatOn(scale, value) : `${formatSi(value, trace.unit)} (no axis left)`;
        if (element.textContent !== text) element.textContent = text;
      });
    });
  }, [traces, plot]);

  return (
    <ul className={styles.legend} aria-label="Signals">
      {traces.map((trace, i) => (
        <li key={trace.name} className={styles.trace}>
          <TraceSwatch colour={trace.colour} dash={trace.dash} />
          <SignalName name={trace.name} />
          <span
            className={styles.value}
            ref={(element) => {
              values.current[i] = element;
            }}
          />
          <button
            type="button"
            className={styles.remove}
            aria-label={`Remove ${trace.name}`}
            onClick={() => onRemove(trace.name)}
          >
            <IconX size={12} />
          </button>
        </li>
      ))}
    </ul>
  );
}
