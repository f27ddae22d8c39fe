import { NativeSelect } from "@mantine/core";
import { useEffect, useMemo, useRef, useState } from "react";
import { useScheme } from "../../app/use-scheme";
import { useView } from "../../app/view-store";
import { useBench } from "../../stream/bench-store";
import { currentEvents } from "../../stream/current-events";
import type { PanelFrame } from "../../stream/panel-frame";
import { stream } from "../../stream/stream";
import { useFeed } from "../../stream/use-feed";
import { hover } from "../../ui/hover";
import { usePanelVisible } from "../../ui/panel-visible";
import { useCanvas } from "../../ui/use-canvas";
import scopeStyles from "../scope/scope.module.css";
import { scopeConfig } from "../scope/scope-config";
import { listenForGestures } from "../scope/scope-gestures";
import { scopeSubscription } from "../scope/time-window";
import { useTimeView } from "../scope/use-time-view";
import { truthSwitches } from "./delays";
import styles from "./lanes.module.css";
import { LanesHeadline } from "./lanes-headline";
import { lanesLayout } from "./lanes-layout";
import { paintLanes } from "./paint-lanes";

const WINDOWS_MS = [2, 4, 10, 20, 50, 100, 200, 500];

/** The lanes of one diagnoser, with their own window into time. */
export function DiagnoserLanes({ id, names }: { id: string; names: string[] }) {
  const scheme = useScheme();
  const large = useView((s) => s.large);
  const dtMs = useBench((s) => s.bench?.dt_ms);
  const events = useBench((s) => s.events);
  const visible = usePanelVisible();
  const over = useRef<HTMLDivElement>(null);
  const frame = useRef<PanelFrame | undefined>(undefined);
  const shown = useRef({ start: 0, end: 1 });
  const dirty = useRef(true);
  const [windowMs, setWindowMs] = useState(20);
  const { canvas, size } = useCanvas();
  const fontSize = large ? 15 : 12;
  const layout = useMemo(
    () => lanesLayout(size.width, size.height, names.length, fontSize),
    [size, names.length, fontSize],
  );
  const switches = useMemo(() => truthSwitches(currentEvents(events), id), [events, id]);
  const { view, span, look, goLive } = useTimeView(windowMs, dtMs, (start, end) => {
    shown.current = { start, end };
    dirty.current = true;
  });

  const subscription = useMemo(() => {
    const pixels = layout.right - layout.left;
    if (!dtMs || pixels < 40) return undefined;
    const signals = [...names.map((name) => `${id}.probability.${name}`), `${id}.winner`, `${id}.truth`];
    return scopeSubscription(scopeConfig(signals, { windowMs }), view, pixels, dtMs);
  }, [id, names, dtMs, layout, windowMs, view]);

  useFeed(subscription, (picture) => {
    if (picture.frozen !== (span.current !== undefined)) return;
    frame.current = picture;
    shown.current = span.current ?? { start: picture.startTick, end: picture.endTick };
    dirty.current = true;
  });

  useEffect(
    () =>
      hover.listen(() => {
        dirty.current = true;
      }),
    [],
  );

  useEffect(() => {
    if (!over.current) return;
    return listenForGestures(over.current, { onSpan: look, onLive: goLive }, () => shown.current);
  }, [look, goLive]);

  useEffect(() => {
    if (!visible) return;
    dirty.current = true;
    return stream.loop.add(() => {
      const ctx = canvas.current?.getContext("2d");
      if (!dirty.current || !ctx || !frame.current || size.width < 80) return;
      dirty.current = false;
      ctx.setTransform(size.ratio, 0, 0, size.ratio, 0, 0);
      ctx.clearRect(0, 0, size.width, size.height);
      paintLanes(ctx, {
        frame: frame.current,
        span: shown.current,
        names,
        layout,
        scheme,
        fontSize,
        switches,
        hover: hover.tick,
      });
    });
  }, [visible, canvas, size, names, layout, scheme, fontSize, switches]);

  const point = (offset: number | undefined) => {
    const width = over.current?.clientWidth ?? 1;
    const { start, end } = shown.current;
    hover.set(offset === undefined ? undefined : start + (offset / width) * (end - start), shown);
  };

  return (
    <section className={styles.lanes} aria-label={`Diagnosis by ${id}`}>
      <div className={styles.toolbar}>
        <LanesHeadline id={id} names={names} switches={switches} />
        <NativeSelect
          size="xs"
          w={84}
          aria-label="Time window"
          value={String(windowMs)}
          data={WINDOWS_MS.map((ms) => ({ value: String(ms), label: `${ms}\u00a0ms` }))}
          onChange={(e) => setWindowMs(Number(e.currentTarget.value))}
        />
        <button
          type="button"
          className={scopeStyles.live}
          data-past={view.kind === "past"}
          aria-pressed={view.kind === "live"}
          onClick={goLive}
        >
          LIVE
        </button>
      </div>
      <div className={styles.plot}>
        <canvas
          ref={canvas}
          className={styles.canvas}
          role="img"
          aria-label={`Probability of ${names.join(", ")} over time`}
        />
        <div
          ref={over}
          className={styles.over}
          style={{ left: layout.left, right: Math.max(0, size.width - layout.right) }}
          onPointerMove={(e) => point(e.nativeEvent.offsetX)}
          onPointerLeave={() => point(undefined)}
        />
      </div>
    </section>
  );
}
