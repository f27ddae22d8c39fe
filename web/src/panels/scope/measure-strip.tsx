import { type RefObject, useEffect, useState } from "react";
import { api } from "../../api/api";
import { ApiError } from "../../api/client";
import { usePanelVisible } from "../../api/panel-visible";
import { useBench } from "../../stream/bench-store";
import { columnAt } from "../../stream/panel-frame";
import { formatCount, formatIn, formatNumber, formatPercent, formatSi } from "../../ui/format";
import { SignalName, TraceSwatch } from "../../ui/trace-swatch";
import { type Columns, type Measurement, measure, referenceFor } from "./measure";
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

interface Reading {
  a: number;
  b: number;
  figures: Measurement | undefined;
}

/** Values at the cursors and figures over the visible span, of every trace. */
export function MeasureStrip({ traces, plot, at }: MeasureStripProps) {
  const id = useBench((s) => s.bench?.id);
  const visible = usePanelVisible();
  const [found, setFound] = useState<{ readings: Reading[]; deltaMs: number; exact: boolean } | undefined>(undefined);

  useEffect(() => {
    if (!id || !visible) return;
    let gone = false;
    let timer: ReturnType<typeof setTimeout>;
    const look = async () => {
      const shown = plot.current;
      if (shown?.frame) {
        const { frame, span } = shown;
        const [start, end] = [Math.floor(span.start), Math.ceil(span.end)];
        try {
          const trace = await api.trace(
            id,
            traces.map((t) => t.name),
            start,
            end,
            MOST_COLUMNS,
          );
          const columns = traces.map(({ name }): Columns => numbers(trace.signals[name]));
          const width = ((trace.end_tick - trace.start_tick) * trace.dt_ms) / columns[0].low.length;
          const tick = (share: number) => span.start + share * (span.end - span.start);
          const readings = traces.map(({ name, unit }, i) => {
            const reference = referenceFor(name, unit, traces);
            return {
              a: columnAt(frame, i, tick(at[0])),
              b: columnAt(frame, i, tick(at[1])),
              figures: measure(columns[i], width, reference === undefined ? undefined : columns[reference]),
            };
          });
          const deltaMs = (at[1] - at[0]) * (span.end - span.start) * frame.dtMs;
          if (!gone) setFound({ readings, deltaMs, exact: end - start <= MOST_COLUMNS });
        } catch (error) {
          if (!(error instanceof ApiError)) throw error; // the page says elsewhere that the server does not answer
        }
      }
      if (!gone) timer = setTimeout(look, EVERY_MS);
    };
    void look();
    return () => {
      gone = true;
      clearTimeout(timer);
    };
  }, [id, visible, traces, plot, at]);

  if (!found) return null;
  const { readings, deltaMs, exact } = found;
  return (
    <section className={styles.measure} aria-label="Measurements">
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
            const { a, b, figures } = readings[i] ?? {};
            const say = (value: number | undefined) => (value === undefined ? "–" : formatSi(value, trace.unit));
            return (
              <tr key={trace.name}>
                <th scope="row">
                  <TraceSwatch colour={trace.colour} dash={trace.dash} />
                  <SignalName name={trace.name} />
                </th>
                <td>{say(a)}</td>
                <td>{say(b)}</td>
                <td>{a === undefined || b === undefined ? "–" : say(b - a)}</td>
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
      {!exact && (
        <small>Figures from minima and maxima: the span is longer than {formatCount(MOST_COLUMNS, "tick")}.</small>
      )}
    </section>
  );
}

const MEANINGS: Record<string, string> = {
  RMS: "over the visible span",
  peak: "largest distance from zero",
  overshoot: "beyond a reference that stands still",
  "settles in": "from the left edge until the distance to the reference stays within 2 % of its amplitude",
  lag: "behind the reference voltage or the model, at its frequency",
  ratio: "of amplitudes to the reference voltage (the effort ratio) or to the model, at its frequency",
};

/** Columns as numbers; where there is no data, no number. */
function numbers(extremes: { min: (number | null)[]; max: (number | null)[] }): Columns {
  return { low: extremes.min.map((v) => v ?? Number.NaN), high: extremes.max.map((v) => v ?? Number.NaN) };
}
