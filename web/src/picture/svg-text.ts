import type { Pen } from "./pen";

export const FAMILY = "IBM Plex Sans, system-ui, sans-serif";

/** The distance of a line of text below its point, in sizes of the font: programs disagree on named baselines. */
const DROP: Record<CanvasTextBaseline, number> = {
  top: 0.85,
  hanging: 0.75,
  middle: 0.35,
  alphabetic: 0,
  ideographic: 0,
  bottom: -0.22,
};
const ANCHOR: Record<CanvasTextAlign, string> = {
  left: "start",
  start: "start",
  center: "middle",
  right: "end",
  end: "end",
};
export const escaped = (text: string) =>
  text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;");

/** Weights between the hundreds are known to variable fonts only. */
function face(font: string): { size: number; weight: number } {
  const [, weight, size] = /^(\d+) ([\d.]+)px/.exec(font) ?? [];
  return { size: Number(size ?? 12), weight: Math.floor(Number(weight ?? 400) / 100) * 100 };
}

/** Width of a text in a font of the canvas, px. */
export function widthIn(font: string, text: string): number {
  const { size, weight } = face(font);
  return textWidth(text, size, weight, FAMILY);
}

/** A line of text as SVG, squeezed into the room it has. */
export function svgText(
  text: string,
  x: string,
  y: number,
  maxWidth: number,
  { font, textAlign, textBaseline }: Pick<Pen, "font" | "textAlign" | "textBaseline">,
  paint: string,
): string {
  const { size, weight } = face(font);
  const baseline = Math.round((y + DROP[textBaseline] * size) * 100) / 100;
  const squeezed =
    widthIn(font, text) > maxWidth ? ` textLength="${Math.round(maxWidth)}" lengthAdjust="spacingAndGlyphs"` : "";
  return (
    `<text x="${x}" y="${baseline}" font-size="${size}" font-weight="${weight}" ` +
    `text-anchor="${ANCHOR[textAlign]}" ${paint}${squeezed}>${escaped(text)}</text>`
  );
}

let ruler: CanvasRenderingContext2D | null | undefined;

/** Width of a line of text, px; without a canvas, an estimate from the usual width of a letter. */
export function textWidth(text: string, size: number, weight: number, family: string): number {
  if (ruler === undefined) ruler = document.createElement("canvas").getContext("2d") ?? null;
  if (!ruler) return 0.55 * size * text.length;
  ruler.font = `${weight} ${size}px ${family}`;
  return ruler.measureText(text).width;
}
