import katex from "katex";
import { Fragment } from "react";
import { keepUnits } from "./format";

/** A formula with the sign after it, which else might begin a line of its own; a name in one of two ways. */
const MATH = /:math:`([^`]+)`([.,;:])?|``([^`]+)``|`([^`]+)`/g;

/** Text of the catalogue, with the mathematics and names in it set as such. */
export function Prose({ text }: { text: string }) {
  return proseParts(text).map((part, i) => {
    const key = `${i}-${part.text}`;
    if (part.kind === "words") return <Fragment key={key}>{keepUnits(part.text)}</Fragment>;
    if (part.kind === "name") return <code key={key}>{part.text}</code>;
    const html = katex.renderToString(part.text, { throwOnError: false, strict: "ignore" });
    // biome-ignore lint/security/noDangerouslySetInnerHtml: KaTeX escapes its input, and trust is off
    return <span key={key} dangerouslySetInnerHTML={{ __html: html }} />;
  });
}

interface ProsePart {
  kind: "words" | "math" | "name";
  text: string;
}

function proseParts(text: string): ProsePart[] {
  const parts: ProsePart[] = [];
  let at = 0;
  for (const match of text.matchAll(MATH)) {
    if (match.index > at) parts.push({ kind: "words", text: text.slice(at, match.index) });
    const [, math, sign, name, short] = match;
    const formula = sign ? `${math}\\text{${sign}}` : math;
    parts.push(math ? { kind: "math", text: formula } : { kind: "name", text: name ?? short });
    at = match.index + match[0].length;
  }
  if (at < text.length) parts.push({ kind: "words", text: text.slice(at) });
  return parts;
}
