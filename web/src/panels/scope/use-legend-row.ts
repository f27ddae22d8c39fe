import { type RefObject, useLayoutEffect, useRef } from "react";
import { useChanged } from "../../ui/use-changed";
import type { PlotTrace } from "./paint-scope";

/** Kept free for the button of the entries without room, px. */
const MORE_PX = 34;
const GAP_PX = 4;

interface LegendRow {
  list: RefObject<HTMLUListElement | null>;
  /** How many entries have room. */
  fits: number;
  level: Level;
}

/** Contents of an entry: its whole name and its value; without the common part of all names; without the value too. */
const LEVELS = ["whole", "short", "names"] as const;

type Level = (typeof LEVELS)[number];

/** How much of a legend has room in one row beside the other tools. Names stay before values do. */
export function useLegendRow(traces: PlotTrace[]): LegendRow {
  const list = useRef<HTMLUListElement>(null);
  const [row, setRow] = useChanged<{ fits: number; level: Level }>({ fits: traces.length, level: "whole" });
  useLayoutEffect(() => {
    const box = list.current;
    const place = box?.parentElement;
    if (!box || !place) return;
    const measure = () => {
      const [first] = place.getElementsByTagName("ul");
      const last = place.lastElementChild as HTMLElement;
      const room = place.clientWidth - last.offsetWidth - GAP_PX;
      const widths = (level: Level) => {
        first.dataset.level = level;
        return [...first.children].map((entry) => (entry as HTMLElement).offsetWidth + GAP_PX);
      };
      first.dataset.alike = String(shareTheRest(traces));
      const level = LEVELS.find((one) => sum(widths(one)) <= room) ?? "names";
      const shown = widths(level);
      const fits = countFitting(shown, room, MORE_PX);
      box.style.maxWidth = `${fits < shown.length ? sum(shown.slice(0, fits)) : room}px`;
      setRow({ fits, level });
    };
    measure();
    const observer = new ResizeObserver(measure);
    observer.observe(place);
    for (const entry of box.children) observer.observe(entry); // a value may grow
    return () => observer.disconnect();
  }, [traces, setRow]);
  return { list, ...row, fits: Math.min(row.fits, traces.length) };
}

const sum = (widths: number[]) => widths.reduce((total, width) => total + width, 0);

/** How many of some widths fit into a room that also holds a button for the rest. */
export function countFitting(widths: number[], room: number, more: number): number {
  if (sum(widths) <= room) return widths.length;
  let taken = more;
  return widths.findIndex((width) => {
    taken += width;
    return taken > room;
  });
}

/** Whether all are the same quantity of several blocks: the block then tells them apart. */
export function shareTheRest(traces: { name: string }[]): boolean {
  const rests = new Set(traces.map(({ name }) => name.split(".").slice(1).join(".")));
  return traces.length > 1 && rests.size === 1;
}
