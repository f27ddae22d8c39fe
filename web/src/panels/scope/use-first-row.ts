import { type RefObject, useLayoutEffect, useRef } from "react";

/** A list that wraps: entries without room in its first row are not shown. */
export function useFirstRow<T extends HTMLElement>(): RefObject<T | null> {
  const list = useRef<T>(null);
  // entries have other widths after each render
  useLayoutEffect(() => {
    const box = list.current;
    if (!box) return;
    const entries = Array.from(box.children) as HTMLElement[];
    const hideRest = () => {
      for (const entry of entries)
        entry.style.visibility = entry.offsetTop > entries[0].offsetTop ? "hidden" : "visible";
    };
    hideRest();
    const observer = new ResizeObserver(hideRest);
    observer.observe(box);
    return () => observer.disconnect();
  });
  return list;
}
