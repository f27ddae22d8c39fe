import { useViewportSize } from "@mantine/hooks";
import { useLayoutEffect } from "react";
import { LECTURE_PX, NORMAL_PX, useView } from "../bench/view-store";

/** Give the page its letters: a lecture is read from the last row, on whatever it is projected. */
export function useReadingSize(phone: boolean): number {
  const large = useView((s) => s.large) && !phone;
  const { width, height } = useViewportSize();
  const scale = readingScale(large, width || window.innerWidth, height || window.innerHeight);
  useLayoutEffect(() => {
    const root = document.documentElement;
    root.dataset.size = large ? "large" : "normal";
    root.style.setProperty("--scale", String(scale));
    useView.setState({ fontPx: large ? LECTURE_PX * scale : NORMAL_PX });
  }, [large, scale]);
  return scale;
}

/** The window for which the sizes of a lecture are made; the sizes grow with a larger window. */
const MADE_FOR = { width: 1366, height: 768 };
const MOST = 3;

/** The factor on the letters of large type in a window of this size. */
export function readingScale(large: boolean, width: number, height: number): number {
  if (!large) return 1;
  return Math.min(MOST, Math.max(1, Math.min(width / MADE_FOR.width, height / MADE_FOR.height)));
}
