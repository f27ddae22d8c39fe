import "katex/dist/katex.min.css";
import katex from "katex";
import { useMemo } from "react";

/** An equation, typeset; the LaTeX itself is there for screen readers by way of MathML. */
export function Formula({ latex, inline = false }: { latex: string; inline?: boolean }) {
  const html = useMemo(
    () =>
      katex.renderToString(latex, {
        displayMode: !inline,
        throwOnError: false,
        output: "htmlAndMathml",
        strict: "ignore",
      }),
    [latex, inline],
  );
  // biome-ignore lint/security/noDangerouslySetInnerHtml: KaTeX escapes its input, and trust is off
  return <span className="formula" dangerouslySetInnerHTML={{ __html: html }} />;
}
