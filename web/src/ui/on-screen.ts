import { type RefObject, useEffect, useState, useSyncExternalStore } from "react";

const subscribe = (changed: () => void) => {
  document.addEventListener("visibilitychange", changed);
  return () => document.removeEventListener("visibilitychange", changed);
};

/** Whether the page is on screen at all: a hidden tab draws nothing and asks for nothing. */
export const usePageVisible = (): boolean =>
  useSyncExternalStore(subscribe, () => document.visibilityState === "visible");

const ENOUGH = 0.3;

/** Whether a good part of an element is scrolled into view. */
export function useOnScreen(element: RefObject<Element | null>): boolean {
  const [shown, setShown] = useState(false);
  useEffect(() => {
    if (!element.current) return;
    const observer = new IntersectionObserver(([entry]) => setShown(entry.isIntersecting), { threshold: ENOUGH });
    observer.observe(element.current);
    return () => observer.disconnect();
  }, [element]);
  return shown;
}
