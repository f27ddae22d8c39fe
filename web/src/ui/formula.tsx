import "katex/dist/katex.min.css";
import katex from "katex";
import { useEffect, useMemo, useRef } from "react";
import styles from "./ui.module.css";

/** An equation, typeset; it breaks at relations when it is longer than its place, and reads as MathML. */
export function Formula({ latex }: { latex: string }) {
  const html = useMemo(
    () =>
      katex.renderToString(`\\displaystyle ${latex}`, {
        throwOnError: false,
        output: "htmlAndMathml",
        strict: "ignore",
      }),
    [latex],
  );
  const place = useRef<HTMLSpanElement>(null);
  useEffect(() => {
    const element = place.current;
    if (!element) return;
    const observer = new ResizeObserver(() => {
      // a formula longer than its place scrolls, by keys too
      if (element.scrollWidth > element.clientWidth) element.tabIndex = 0;
      else element.removeAttribute("tabindex");
    });
    observer.observe(element);
    return () => observer.disconnect();
  }, []);
  // biome-ignore lint/security/noDangerouslySetInnerHtml: KaTeX escapes its input, and trust is off
  return <span ref={place} className={styles.formula} dangerouslySetInnerHTML={{ __html: html }} />;
}
