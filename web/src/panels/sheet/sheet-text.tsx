import "katex/dist/katex.min.css";
import katex from "katex";
import Markdown, { type Components } from "react-markdown";
import remarkMath from "remark-math";
import { Formula } from "../../ui/formula";
import styles from "./sheet.module.css";

/** The elements of a text; the HTML of a sheet stays text, and nothing is loaded from other places. */
const ELEMENTS = ["p", "em", "strong", "code", "pre", "ul", "ol", "li", "a", "blockquote", "h3", "h4", "br", "hr"];
/** Mathematics that has lines of its own; the reader wants its marks on lines of their own as well. */
const OWN_LINES = /^\$\$([^$]+)\$\$$/gm;
const PLUGINS = [remarkMath];
const COMPONENTS: Components = {
  code: ({ className = "", children }) => {
    if (!className.includes("language-math")) return <code>{children}</code>;
    if (className.includes("math-display")) return <Formula latex={String(children)} />;
    const html = katex.renderToString(String(children), {
      throwOnError: false,
      output: "htmlAndMathml",
      strict: "ignore",
    });
    // biome-ignore lint/security/noDangerouslySetInnerHtml: KaTeX escapes its input, and trust is off
    return <span className={styles.math} dangerouslySetInnerHTML={{ __html: html }} />;
  },
  // mathematics of its own line comes as a block of code; it is no code
  pre: ({ children }) => <div className={styles.block}>{children}</div>,
  a: ({ href, children }) => (
    <a href={href} target="_blank" rel="noreferrer">
      {children}
    </a>
  ),
};

/** A text of a sheet: Markdown, with mathematics between dollar signs. */
export function SheetText({ text }: { text: string }) {
  if (!text) return null;
  return (
    <div className={styles.text}>
      <Markdown remarkPlugins={PLUGINS} allowedElements={ELEMENTS} unwrapDisallowed components={COMPONENTS}>
        {text.replace(OWN_LINES, "\n$$$$\n$1\n$$$$\n")}
      </Markdown>
    </div>
  );
}
