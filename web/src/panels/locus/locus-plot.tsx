import { type RefObject, useEffect, useMemo, useRef } from "react";
import { LiveCanvas } from "../../picture/live-canvas";
import type { Box, Look, Pen } from "../../picture/pen";
import { middles } from "../../stream/panel-frame";
import { TraceSwatch } from "../../ui/trace-swatch";
import { unitScale } from "../../ui/unit-scale";
import styles from "../phase/phase.module.css";
import { useTicks } from "../phase/use-ticks";
import { useTraces } from "../scope/use-traces";
import { type LocusAxes, locusAxes, type Points, tiltDeg } from "./locus-axes";
import { type LocusShown, paintLocus, tiltText } from "./paint-locus";

/** A mass in its plane: its name, and its two signals. */
export interface Mass {
  name: string;
  x: string;
  y: string;
}

interface LocusPlotProps {
  masses: readonly Mass[];
  windowMs: number;
  stretched: boolean;
  /** Keeps the newest picture. */
  painted: RefObject<LocusShown | undefined>;
  /** The meaning of the path. */
  meaning?: string;
}

/** The canvas of a locus, and the tilt of each trace in words. */
export function LocusPlot({ masses, windowMs, stretched, painted, meaning }: LocusPlotProps) {
  const names = useMemo(() => masses.flatMap(({ x, y }) => [x, y]), [masses]);
  const traces = useTraces(names);
  const words = useRef<(HTMLElement | null)[]>([]);
  const points = useRef<Points[]>([]);
  const axes = useRef<LocusAxes | undefined>(undefined);
  const subscription = useTicks(names, windowMs);

  // biome-ignore lint/correctness/useExhaustiveDependencies: another scale begins with other axes
  useEffect(() => {
    axes.current = undefined;
  }, [stretched, masses]);

  const paint = (pen: Pen, box: Box, look: Look, tells: boolean) => {
    if (traces.length < names.length) return;
    axes.current = locusAxes(axes.current, points.current, stretched);
    const { x, y } = axes.current;
    painted.current = {
      axes: axes.current,
      scales: { x: unitScale(traces[0].unit, x[1]), y: unitScale(traces[1].unit, y[1]) },
      traces: points.current.map((path, i) => ({
        name: masses[i].name,
        slot: traces[2 * i].slot,
        points: path,
        tiltDeg: tiltDeg(path.x, path.y),
      })),
    };
    paintLocus(pen, box, painted.current, look);
    if (!tells) return;
    painted.current.traces.forEach(({ tiltDeg: degrees }, i) => {
      const place = words.current[i];
      if (place) place.textContent = tiltText(degrees);
    });
  };

  return (
    <div className={styles.parts}>
      <LiveCanvas
        label="Path of the mass: y over x"
        subscription={subscription}
        hear={(frame) => {
          points.current = masses.map((_, i) => ({ x: middles(frame, 2 * i), y: middles(frame, 2 * i + 1) }));
        }}
        paint={paint}
      />
      <div>
        <p className={styles.words}>
          {masses.map(({ name, x }, i) => (
            <span key={name} style={{ marginRight: 16 }}>
              <TraceSwatch colour={traces.find((t) => t.name === x)?.colour ?? ""} dash={0} /> {name}: long axis{" "}
              <b
                data-testid="tilt"
                ref={(place) => {
                  words.current[i] = place;
                }}
              />
            </span>
          ))}
        </p>
        {meaning && <p className={styles.words}>{meaning}</p>}
      </div>
    </div>
  );
}
