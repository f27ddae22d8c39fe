import { Popover } from "@mantine/core";
import { type RefObject, useEffect, useRef } from "react";
import { useNarrator } from "../../bench/narrator";
import { stream } from "../../stream/stream";
import { formatOn, formatSi } from "../../ui/format";
import { SignalName, TraceSwatch } from "../../ui/trace-swatch";
import type { PlotTrace } from "./paint-scope";
import styles from "./scope.module.css";
import type { ScopePlot } from "./scope-plot";
import { shareTheRest, useLegendRow } from "./use-legend-row";

const EVERY_MS = 90;

interface ScopeLegendProps {
  traces: PlotTrace[];
  plot: RefObject<ScopePlot | undefined>;
}

/** Names and values in one row, names alone where values have no room; a button has the signals without room. */
export function ScopeLegend({ traces, plot }: ScopeLegendProps) {
  const { list, fits, level } = useLegendRow(traces);
  const entry = (trace: PlotTrace, index: number, hidden = false) => (
    <LegendEntry key={trace.name} trace={trace} index={index} hidden={hidden} plot={plot} />
  );
  return (
    <>
      <ul
        ref={list}
        className={styles.legend}
        aria-label="Signals"
        data-level={level}
        data-alike={shareTheRest(traces)}
      >
        {traces.map((trace, i) => entry(trace, i, i >= fits))}
      </ul>
      {fits < traces.length && (
        <Popover position="bottom-start">
          <Popover.Target>
            <button type="button" className={styles.more} title="The other signals of this scope">
              +{traces.length - fits}
            </button>
          </Popover.Target>
          <Popover.Dropdown>
            <ul aria-label="Other signals">{traces.slice(fits).map((trace, i) => entry(trace, fits + i))}</ul>
          </Popover.Dropdown>
        </Popover>
      )}
    </>
  );
}

interface LegendEntryProps {
  trace: PlotTrace;
  index: number;
  hidden: boolean;
  plot: RefObject<ScopePlot | undefined>;
}

/** A trace and its value at the hovered time, or the newest one. */
function LegendEntry({ trace, index, hidden, plot }: LegendEntryProps) {
  const value = useRef<HTMLSpanElement>(null);
  useEffect(() => {
    if (hidden) return;
    let last = 0;
    return stream.loop.add(() => {
      const now = performance.now();
      if (now - last < EVERY_MS || !plot.current || !value.current) return;
      last = now;
      const scale = plot.current.scaleOf(trace.unit);
      const reading = plot.current.reading(index);
      const text = scale ? formatOn(scale, reading) : `${formatSi(reading, trace.unit)} (no axis left)`;
      if (value.current.textContent !== text) value.current.textContent = text;
    });
  }, [trace, index, hidden, plot]);
  const told = useNarrator((s) => s.chosen?.signals.includes(trace.name) ?? false);
  return (
    <li className={`line ${styles.trace}`} data-hidden={hidden} data-told={told}>
      <TraceSwatch colour={trace.colour} dash={trace.dash} />
      <SignalName name={trace.name} />
      <span className={styles.value} ref={value} />
    </li>
  );
}
