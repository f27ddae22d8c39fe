import { useViewportSize } from "@mantine/hooks";
import { useLayoutEffect } from "react";
import { LECTURE_PX, NORMAL_PX, useView } from "../bench/view-store";
import { readingScale } from "./reading-scale";

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
