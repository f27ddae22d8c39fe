import { useDocumentVisibility } from "@mantine/hooks";
import { type RefObject, useEffect, useState } from "react";

/** Whether the page is on screen at all: a hidden tab draws nothing and asks for nothing. */
export const usePageVisible = (): boolean => useDocumentVisibility() === "visible";

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
