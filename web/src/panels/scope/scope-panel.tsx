import { Box, Text } from "@mantine/core";
import { useEffect, useMemo, useRef, useState } from "react";
import { behindText, useBehind } from "../../bench/behind";
import { marksNow } from "../../bench/marks";
import { marksOver, useMarks, usePrinted } from "../../bench/printed";
import { NORMAL_PX, useView } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import type { PanelFrame } from "../../stream/panel-frame";
import type { ScopeConfig } from "../../stream/scope-config";
import { stream } from "../../stream/stream";
import { useFeed } from "../../stream/use-feed";
import { EmptyState } from "../../ui/empty-state";
import { formatSi } from "../../ui/format";
import { useScheme } from "../../ui/use-canvas";
import { BeforeAfter } from "./before-after";
import { CaptureStrip } from "./capture-strip";
import { EnvelopeNote } from "./envelope-note";
import { ExportMenu } from "./export-menu";
import { MeasureStrip } from "./measure-strip";
import { PresetButtons } from "./preset-buttons";
import { PrintedLine } from "./printed-line";
import styles from "./scope.module.css";
import { type CursorPair, type PlotArea, ScopeCursors } from "./scope-cursors";
import { ScopeLegend } from "./scope-legend";
import { ScopePlot } from "./scope-plot";
import { ScopeToolbar } from "./scope-toolbar";
import { SignalPicker } from "./signal-picker";
import type { TriggerState } from "./trigger-menu";
import { useBeforeAfter } from "./use-before-after";
import { useCaptures } from "./use-captures";
import { useOnBench } from "./use-on-bench";
import { useScopeKeys } from "./use-scope-keys";
import { scopeSubscription, useTimeView } from "./use-time-view";
import { useTraces, useTracesBehind } from "./use-traces";

/** Traces between cursors, 140 px high, with the letters of the axes. */
const MEASURED = "calc(140px + 3 * var(--size-1))";

interface ScopePanelProps {
  config: ScopeConfig;
  onChange(config: ScopeConfig): void;
}

/** An oscilloscope: it rolls, triggers, or shows a span of the past while the board runs on. */
export function ScopePanel({ config: kept, onChange }: ScopePanelProps) {
  const { config, drives } = useOnBench(kept);
  const scheme = useScheme();
  const fontSize = useView((s) => s.fontPx);
  const dtMs = useBench((s) => s.bench?.dt_ms);
  const isBlind = useBench((s) => Boolean(s.bench?.blind));
  const traces = useTraces(config.signals, drives);
  const behind = useBehind((s) => s.behind);
  const difference = useBehind((s) => s.difference);
  const tracesBehind = useTracesBehind(traces, behind, difference);
  const marks = useMarks();
  const isPrinted = usePrinted((s) => s.isShown);
  const names = useMemo(() => traces.map((t) => t.name), [traces]);
  const printed = useMemo(() => marksOver(marks, names), [marks, names]);
  const drawn = useRef<typeof printed>([]);
  drawn.current = isPrinted ? printed : [];
  const host = useRef<HTMLDivElement>(null);
  const plot = useRef<ScopePlot | undefined>(undefined);
  const { view, span, look, stand, goLive } = useTimeView(config.windowMs, dtMs, (start, end) =>
    plot.current?.move(start, end),
  );
  const [pixels, setPixels] = useState(0);
  const [area, setArea] = useState<PlotArea | undefined>(undefined);
  const [cursors, setCursors] = useState<CursorPair>(kept.cursors ?? [0.25, 0.75]);
  const [trigger, setTrigger] = useState<TriggerState>("none");

  const subscription = useMemo(() => {
    if (!dtMs || names.length === 0 || pixels < 20) return undefined;
    return scopeSubscription({ ...config, signals: names }, view, pixels, dtMs, behind);
  }, [config, names, view, pixels, dtMs, behind]);

  const capture = view.kind === "past" ? view.capture : undefined;
  const { captures, hear, browse } = useCaptures(config, capture, stand, goLive);
  const draw = (frame: PanelFrame) => {
    if (frame.frozen !== (span.current !== undefined)) return;
    plot.current?.draw(frame, span.current, capture?.trigger_tick);
    const state: TriggerState = frame.waiting ? "waiting" : frame.triggered ? "triggered" : "none";
    if (state !== trigger) setTrigger(state);
  };
  const feed = useFeed(subscription, draw, 0, hear);
  const { change, isHidden, figures, ghosts, ghost } = useBeforeAfter(traces, config.windowMs, () =>
    feed.current?.redraw(),
  );

  useEffect(() => {
    if (!host.current || traces.length === 0) return;
    const made = new ScopePlot({
      host: host.current,
      traces: [...traces, ...tracesBehind, ...ghosts],
      scheme,
      lineWidth: fontSize > NORMAL_PX ? 0.17 * fontSize : 1.6,
      fontSize,
      marks: marksNow,
      printed: () => drawn.current,
      isLog: config.log ?? false,
      isShaded: () => useBehind.getState().shaded,
      ghost: () => ghost.current(),
      gestures: { onSpan: look, onLive: goLive },
    });
    plot.current = made;
    feed.current?.redraw();
    const measured = () => {
      setPixels(made.pixels);
      setArea(made.area);
    };
    measured();
    const observer = new ResizeObserver(([entry]) => {
      made.resize(entry.contentRect.width, entry.contentRect.height);
      measured();
    });
    observer.observe(host.current);
    return () => {
      observer.disconnect();
      made.destroy();
      plot.current = undefined;
    };
  }, [traces, tracesBehind, ghosts, ghost, config.log, scheme, fontSize, look, goLive, feed]);

  // biome-ignore lint/correctness/useExhaustiveDependencies: other printed marks need another picture
  useEffect(() => feed.current?.redraw(), [printed, isPrinted, feed]);

  const sayTime = (share: number) => {
    const shown = plot.current;
    return shown?.frame
      ? formatSi((shown.span.start + share * (shown.span.end - shown.span.start)) * shown.frame.dtMs, "ms")
      : "";
  };
  const onKeyDown = useScopeKeys(plot, look, goLive, browse);
  if (dtMs === undefined)
    return <EmptyState title="No bench yet">The scope fills as soon as a bench is connected.</EmptyState>;
  return (
    <section className="view" aria-label={`Scope: ${names.join(", ") || "empty"}`}>
      <ScopeToolbar
        config={config}
        onChange={onChange}
        past={view.kind === "past"}
        onLive={goLive}
        trigger={trigger}
        onRearm={() => feed.current && stream.client.feeds.rearm(feed.current)}
        exporter={(tools) => traces.length > 0 && <ExportMenu plot={plot} capture={capture} tools={tools} />}
      >
        {!config.measure && ( // the table names them too, and its rows want the room
          <ScopeLegend traces={traces} plot={plot} />
        )}
        <SignalPicker
          chosen={config.signals}
          onChange={(signals) => onChange({ ...config, signals })}
          isLog={config.log ?? false}
          onLog={(log) => onChange({ ...config, log })}
        />
      </ScopeToolbar>
      {traces.length === 0 ? (
        <EmptyState
          title={isBlind && kept.signals.length > 0 ? "Hidden until you answer" : "Nothing on this scope"}
          action={<PresetButtons onChoose={(chosen) => onChange({ ...config, signals: chosen })} />}
        >
          {isBlind
            ? "Pick signals with +, or begin with a set. Signals that would tell the fault are hidden."
            : "Pick signals with +, or begin with a set. Every signal of the bench can be shown, taps inside the blocks included."}
        </EmptyState>
      ) : (
        <>
          {change && <BeforeAfter change={change} isHidden={isHidden} figures={figures} traces={traces} plot={plot} />}
          <Box pos="relative" flex={`1 0 ${config.measure ? MEASURED : "90px"}`} m="0 4px 2px">
            {/* biome-ignore lint/a11y/useSemanticElements: a live plot has no element of its own */}
            <div
              ref={host}
              className={styles.plot}
              role="group"
              // biome-ignore lint/a11y/noNoninteractiveTabindex: the plot is worked by keys
              tabIndex={0}
              onKeyDown={onKeyDown}
              aria-label={`Plot. Arrow keys move, plus and minus zoom, L returns to live.${
                captures ? " Page up and page down go through the captures, End to the newest." : ""
              }`}
            />
            <EnvelopeNote traces={traces} plot={plot} />
            {config.measure && area && (
              <ScopeCursors
                area={area}
                at={cursors}
                say={sayTime}
                onMove={setCursors}
                onRest={() => onChange({ ...kept, cursors })}
              />
            )}
          </Box>
          {captures && (
            <CaptureStrip captures={captures} standing={capture} dtMs={dtMs} onStand={stand} onBrowse={browse} />
          )}
          {behind.length > 0 && (
            <Text inherit truncate c="dimmed" fz="sm" p="0 12px 4px">
              {behindText(behind, difference)}
            </Text>
          )}
          {printed.length > 0 && <PrintedLine marks={printed} />}
          {config.measure && <MeasureStrip traces={traces} plot={plot} at={cursors} />}
        </>
      )}
    </section>
  );
}
