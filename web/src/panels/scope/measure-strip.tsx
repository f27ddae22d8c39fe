import { Box } from "@mantine/core";
import { type RefObject, useId } from "react";
import { api } from "../../api/api";
import { useAnswer } from "../../api/queries";
import { useBench } from "../../stream/bench-store";
import { columnAt } from "../../stream/panel-frame";
import { formatCount, formatIn, formatNumber, formatPercent, formatSi } from "../../ui/format";
import { SignalName, TraceSwatch } from "../../ui/trace-swatch";
import { type Columns, measure, referenceFor } from "./measure";
import type { PlotTrace } from "./paint-scope";
import styles from "./scope.module.css";
import type { CursorPair } from "./scope-cursors";
import type { ScopePlot } from "./scope-plot";

const EVERY_MS = 300;
const MOST_COLUMNS = 4096;

interface MeasureStripProps {
  traces: PlotTrace[];
  plot: RefObject<ScopePlot | undefined>;
  at: CursorPair;
}

/** Values at the cursors and figures over the visible span, of every trace. */
export function MeasureStrip({ traces, plot, at }: MeasureStripProps) {
  const panel = useId();
  const id = useBench((s) => s.bench?.id) ?? "";
  const names = traces.map((t) => t.name);
  const { value: found } = useAnswer(
    ["measure", panel, id, names],
    async () => {
      if (!plot.current?.frame) return null;
      const { span } = plot.current;
      const [start, end] = [Math.floor(span.start), Math.ceil(span.end)];
      const trace = await api.trace(id, names, start, end, MOST_COLUMNS);
      const columns = names.map((name): Columns => numbers(trace.signals[name]));
      const width = ((trace.end_tick - trace.start_tick) * trace.dt_ms) / columns[0].low.length;
      const figures = traces.map(({ name, unit }, i) => {
        const reference = referenceFor(name, unit, traces);
        return measure(columns[i], width, reference === undefined ? undefined : columns[reference]);
      });
      return { figures, isExact: end - start <= MOST_COLUMNS };
    },
    () => EVERY_MS,
  );

  const { frame, span } = plot.current ?? {};
  if (!found || !frame || !span) return null;
  const length = span.end - span.start;
  const deltaMs = (at[1] - at[0]) * length * frame.dtMs;
  const valueAt = (trace: number, cursor: 0 | 1) => columnAt(frame, trace, span.start + at[cursor] * length);
  return (
    <Box component="section" className={styles.measure} flex="none" p="0 12px 6px" fz="sm" aria-label="Measurements">
      <table>
        <thead>
          <tr>
            <th scope="col" className={styles.between}>
              Δt <b>{formatSi(deltaMs, "ms")}</b> 1/Δt <b>{deltaMs ? formatSi(1 / deltaMs, "kHz") : "–"}</b>
            </th>
            {["A", "B", "B − A", "RMS", "peak", "frequency", "overshoot", "settles in", "lag", "ratio"].map((name) => (
              <th key={name} scope="col" title={MEANINGS[name]}>
                {name}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {traces.map((trace, i) => {
            const [a, b] = [valueAt(i, 0), valueAt(i, 1)];
            const figures = found.figures[i];
            const say = (value: number | undefined) => (value === undefined ? "–" : formatSi(value, trace.unit));
            return (
              <tr key={trace.name}>
                <th scope="row">
                  <TraceSwatch colour={trace.colour} dash={trace.dash} />
                  <SignalName name={trace.name} />
                </th>
                <td>{say(a)}</td>
                <td>{say(b)}</td>
                <td>{say(b - a)}</td>
                <td>{say(figures?.rms)}</td>
                <td>{say(figures?.peak)}</td>
                <td>{figures?.frequency === undefined ? "–" : formatSi(figures.frequency, "kHz")}</td>
                <td>{figures?.overshoot === undefined ? "–" : formatPercent(figures.overshoot)}</td>
                <td>{figures?.settling === undefined ? "–" : formatSi(figures.settling, "ms", 3)}</td>
                <td>{figures?.phaseLag === undefined ? "–" : formatIn(figures.phaseLag, "°", 1)}</td>
                <td>{figures?.ratio === undefined ? "–" : formatNumber(figures.ratio, 3)}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
      {!found.isExact && (
        <small>Figures from minima and maxima: the span is longer than {formatCount(MOST_COLUMNS, "tick")}.</small>
      )}
    </Box>
  );
}

const MEANINGS: Record<string, string> = {
  RMS: "over the visible span",
  peak: "largest distance from zero",
  overshoot: "beyond a constant reference",
  "settles in": "from the left edge until the distance to the reference stays within 2 % of its amplitude",
  lag: "behind the reference voltage or the model, at its frequency",
  ratio: "of amplitudes to the reference voltage (the effort ratio) or to the model, at its frequency",
};

/** Columns as numbers; where there is no data, no number. */
function numbers(extremes: { min: (number | null)[]; max: (number | null)[] }): Columns {
  return { low: extremes.min.map((v) => v ?? Number.NaN), high: extremes.max.map((v) => v ?? Number.NaN) };
}
