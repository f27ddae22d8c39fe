import { useCallback, useEffect, useRef, useState } from "react";
import type { Behind } from "../../bench/behind";
import type { ScopeConfig } from "../../stream/scope-config";
import type { CaptureMark, Subscription } from "../../stream/wire";
import { jump } from "../../ui/hover";

const LIVE: TimeWindow = { kind: "live" };
const REFETCH_MS = 60;

/**
 * The window of a time panel. `span` moves at once with the hand and holds ticks while the panel is detached;
 * `view` follows a moment later and asks the server for the detail. A capture stays until the panel goes live.
 */
export function useTimeView(windowMs: number, dtMs: number | undefined, onMove: (start: number, end: number) => void) {
  const span = useRef<Span | undefined>(undefined);
  const refetch = useRef<ReturnType<typeof setTimeout> | undefined>(undefined);
  const move = useRef(onMove);
  move.current = onMove;
  const [view, setView] = useState<TimeWindow>(LIVE);
  const capture = useRef<CaptureMark | undefined>(undefined);

  const goLive = useCallback(() => {
    clearTimeout(refetch.current);
    span.current = capture.current = undefined;
    setView(LIVE);
  }, []);

  const stand = useCallback((on: CaptureMark) => {
    clearTimeout(refetch.current);
    capture.current = on;
    const shown = { start: on.start_tick, end: on.end_tick };
    span.current = shown;
    setView({ kind: "past", ...shown, capture: on });
  }, []);

  const look = useCallback((start: number, end: number) => {
    span.current = { start, end };
    move.current(start, end);
    clearTimeout(refetch.current);
    refetch.current = setTimeout(() => setView({ kind: "past", start, end, capture: capture.current }), REFETCH_MS);
  }, []);

  useEffect(
    () =>
      jump.listen((target) => {
        if (target === "live") return goLive();
        capture.current = undefined;
        const width = windowMs / (dtMs ?? 1);
        look(target.tick - width * 0.25, target.tick + width * 0.75);
      }),
    [goLive, look, windowMs, dtMs],
  );
  useEffect(() => () => clearTimeout(refetch.current), []);
  return { view, span, look, stand, goLive };
}

/** The window of a scope: the newest data, or a fixed span of the past, of a capture or not. */
export type TimeWindow = { kind: "live" } | { kind: "past"; start: number; end: number; capture?: CaptureMark };

/** A stretch of ticks. */
export interface Span {
  start: number;
  end: number;
}

const LEAST_TICKS = 8;

/** Zoom a span about one of its ticks. */
export function zoomSpan(start: number, end: number, about: number, factor: number): Span {
  const width = Math.max(LEAST_TICKS, (end - start) * factor);
  const share = (about - start) / (end - start);
  return { start: about - width * share, end: about + width * (1 - share) };
}

/** Of a scope with all benches behind it; the server allows four times as many for all panels together. */
const MOST_POINTS = 65_536;

/** Columns that a picture of so many traces may have. */
export const mostColumns = (traces: number): number => Math.min(4096, Math.floor(MOST_POINTS / traces));

/** The subscription that fills `pixels` columns with the window of a scope. */
export function scopeSubscription(
  config: ScopeConfig,
  window: TimeWindow,
  pixels: number,
  dtMs: number,
  behind: readonly Behind[] = [],
): Subscription {
  const asked = {
    signals: config.signals,
    ...(behind.length > 0 && { behind: behind.map(({ bench, shift }) => ({ bench, shift_ticks: shift })) }),
  };
  const most = mostColumns(config.signals.length * (1 + behind.length));
  const width = (ticks: number) => Math.max(2, Math.min(Math.round(pixels), Math.ceil(ticks), most));
  const window_ms = config.windowMs;
  if (window.kind === "past") {
    const start_tick = Math.floor(window.start);
    const end_tick = Math.max(start_tick + 1, Math.ceil(window.end));
    const scope = config.mode === "triggered" && { window_ms, trigger: config.trigger };
    return { mode: "frozen", ...asked, start_tick, end_tick, width: width(end_tick - start_tick), ...scope };
  }
  if (config.mode === "triggered")
    return { mode: "triggered", ...asked, window_ms, width: width(window_ms / dtMs), trigger: config.trigger };
  return { mode: "roll", ...asked, window_ms, width: width(window_ms / dtMs) };
}
