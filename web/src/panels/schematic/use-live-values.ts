import { useCallback, useMemo, useRef } from "react";
import { useCatalog } from "../../api/use-catalog";
import { useBench } from "../../stream/bench-store";
import { useFeed } from "../../stream/use-feed";
import { formatOn } from "../../ui/format";
import { unitScale } from "../../ui/unit-scale";

const EVERY_MS = 100;
const FORGET = 0.995;
/** Beyond any voltage or stroke: a controller on its way to infinity. */
const IMMENSE = 1e9;

/**
 * Newest values of named signals, written straight into elements; give each element `live(key)` as its ref.
 *
 * `say` may have words of its own for a value.
 */
export function useLiveValues(shown: Record<string, string>, say?: (key: string, value: number) => string | undefined) {
  const signals = useBench((s) => s.bench?.signals);
  const elements = useRef(new Map<string, Element>());
  const peaks = useRef(new Map<string, number>());
  const entries = useMemo(
    () =>
      Object.entries(shown).flatMap(([key, name]) => {
        const signal = signals?.find((s) => s.name === name);
        return signal ? [{ key, name, unit: signal.unit }] : [];
      }),
    [shown, signals],
  );
  const subscription = useMemo(
    () =>
      entries.length
        ? { mode: "roll" as const, signals: entries.map((e) => e.name), window_ms: 0.5, width: 2 }
        : undefined,
    [entries],
  );
  useFeed(
    subscription,
    (frame) => {
      entries.forEach(({ key, unit }, i) => {
        const value = frame.latest[i];
        const high = Math.max(Math.abs(frame.data[i * 2 * frame.columns]) || 0, Math.abs(value) || 0);
        const words = () => {
          if (frame.endTick <= 0) return "–"; // no sample has come
          if (!Number.isFinite(value) || high > IMMENSE) return "not finite";
          const said = say?.(key, value);
          if (said !== undefined) return said;
          const peak = Math.max(high, (peaks.current.get(key) ?? 0) * FORGET);
          peaks.current.set(key, peak);
          return formatOn(unitScale(unit, peak, 3), value);
        };
        const element = elements.current.get(key);
        if (element) element.textContent = words();
      });
    },
    EVERY_MS,
  );
  return useCallback(
    (key: string) => (element: Element | null) => {
      if (element) elements.current.set(key, element);
      else elements.current.delete(key);
    },
    [],
  );
}

/** The faults that act on the bench now: their names, and the part each is seen on. */
export function useActingFaults(): { title: string; shows: string | null | undefined }[] {
  const faults = useBench((s) => s.bench?.faults) ?? [];
  const { block } = useCatalog();
  return faults
    .filter((fault) => fault.severity !== 0)
    .map(({ name }) => {
      const card = block("faults", name);
      return { title: card?.title ?? name.replaceAll("_", " "), shows: card?.shows };
    });
}
