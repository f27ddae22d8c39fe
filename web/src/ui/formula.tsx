import "katex/dist/katex.min.css";
import katex from "katex";
import { useMemo } from "react";
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
  // biome-ignore lint/security/noDangerouslySetInnerHtml: KaTeX escapes its input, and trust is off
  return <span className={styles.formula} dangerouslySetInnerHTML={{ __html: html }} />;
}
