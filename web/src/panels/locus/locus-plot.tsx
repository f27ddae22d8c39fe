import { type Ref, useEffect, useImperativeHandle, useMemo, useRef } from "react";
import { usePanelVisible } from "../../api/panel-visible";
import { useView } from "../../bench/view-store";
import type { TakePicture } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import { middles } from "../../stream/panel-frame";
import { stream } from "../../stream/stream";
import { useFeed } from "../../stream/use-feed";
import type { Subscription } from "../../stream/wire";
import { unitScale } from "../../ui/unit-scale";
import { useCanvas, useScheme } from "../../ui/use-canvas";
import styles from "../phase/phase.module.css";
import { useTraces } from "../scope/use-traces";
import { type LocusAxes, locusAxes, type Points, tiltDeg } from "./locus-axes";
import { type LocusShown, locusPicture, paintLocus, tiltText } from "./paint-locus";

const MOST_COLUMNS = 4096;
/** A figure that changes more often cannot be read. */
const WORDS_MS = 200;

/** A mass in its plane: what it is called, and its two signals. */
export interface Mass {
  name: string;
  x: string;
  y: string;
}

interface LocusPlotProps {
  masses: readonly Mass[];
  windowMs: number;
  stretched: boolean;
  picture: Ref<TakePicture>;
}

/** The canvas of a locus, and the tilt of each trace in words. */
export function LocusPlot({ masses, windowMs, stretched, picture }: LocusPlotProps) {
  const scheme = useScheme();
  const fontSize = useView((s) => s.fontPx);
  const visible = usePanelVisible();
  const dtMs = useBench((s) => s.bench?.dt_ms);
  const names = useMemo(() => masses.flatMap(({ x, y }) => [x, y]), [masses]);
  const traces = useTraces(names);
  const { canvas, size } = useCanvas();
  const words = useRef<(HTMLElement | null)[]>([]);
  const said = useRef(0);
  const points = useRef<Points[]>([]);
  const axes = useRef<LocusAxes | undefined>(undefined);
  const dirty = useRef(true);
  const painted = useRef<LocusShown | undefined>(undefined);
  useImperativeHandle(picture, () => () => painted.current && locusPicture(painted.current), []);

  const subscription = useMemo<Subscription | undefined>(() => {
    if (!dtMs) return undefined;
    const width = Math.max(2, Math.min(MOST_COLUMNS, Math.round(windowMs / dtMs)));
    return { mode: "roll", signals: names, window_ms: windowMs, width };
  }, [names, windowMs, dtMs]);

  useFeed(subscription, (frame) => {
    points.current = masses.map((_, i) => ({ x: middles(frame, 2 * i), y: middles(frame, 2 * i + 1) }));
    dirty.current = true;
  });

  // biome-ignore lint/correctness/useExhaustiveDependencies: another scale begins with other axes
  useEffect(() => {
    axes.current = undefined;
    dirty.current = true;
  }, [stretched, masses]);

  useEffect(() => {
    if (!visible) return;
    dirty.current = true;
    return stream.loop.add(() => {
      const ctx = canvas.current?.getContext("2d");
      if (!dirty.current || !ctx || size.width < 120 || size.height < 100 || traces.length < names.length) return;
      dirty.current = false;
      axes.current = locusAxes(axes.current, points.current, stretched);
      const { x, y } = axes.current;
      ctx.setTransform(size.ratio, 0, 0, size.ratio, 0, 0);
      ctx.clearRect(0, 0, size.width, size.height);
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
      paintLocus(ctx, size, painted.current, { scheme, fontSize });
      const now = performance.now();
      if (now - said.current < WORDS_MS) return;
      said.current = now;
      painted.current.traces.forEach(({ tiltDeg: degrees }, i) => {
        const place = words.current[i];
        if (place) place.textContent = tiltText(degrees);
      });
    });
  }, [visible, canvas, size, traces, names, masses, stretched, scheme, fontSize]);

  return (
    <>
      <div className={styles.plot}>
        <canvas ref={canvas} className={styles.canvas} role="img" aria-label="Path of the mass: y over x" />
      </div>
      <p className={styles.words}>
        {masses.map(({ name, x }, i) => (
          <span key={name} style={{ marginRight: 16 }}>
            <i className={styles.key} style={{ background: traces.find((t) => t.name === x)?.colour }} /> {name}: long
            axis{" "}
            <b
              data-testid="tilt"
              ref={(place) => {
                words.current[i] = place;
              }}
            />
          </span>
        ))}
      </p>
    </>
  );
}
