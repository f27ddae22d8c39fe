import type { Pen } from "./pen";
import { escaped, FAMILY, svgText, widthIn } from "./svg-text";

const STATE = [
  "fillStyle",
  "strokeStyle",
  "lineWidth",
  "lineJoin",
  "font",
  "textAlign",
  "textBaseline",
  "globalAlpha",
  "dashes",
  "opened",
] as const;

const n = (value: number) => String(Math.round(value * 100) / 100);
const allFinite = (...values: number[]) => values.every(Number.isFinite);

/** A pen that writes SVG. Like a canvas it skips calls with coordinates that are not finite. */
export class SvgPen implements Pen {
  fillStyle: Pen["fillStyle"] = "#000000";
  strokeStyle: Pen["strokeStyle"] = "#000000";
  lineWidth = 1;
  lineJoin: CanvasLineJoin = "miter";
  font = "400 12px sans-serif";
  textAlign: CanvasTextAlign = "left";
  textBaseline: CanvasTextBaseline = "alphabetic";
  globalAlpha = 1;
  private dashes = "";
  /** Groups begun since the last `save`. */
  private opened = 0;
  private path = "";
  private clips = 0;
  private readonly saved: Partial<SvgPen>[] = [];
  private readonly out: string[] = [];

  /** All that was drawn, on white. */
  svg(width: number, height: number, title: string): string {
    while (this.saved.length) this.restore();
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" width="${n(width)}" height="${n(height)}" viewBox="0 0 ${n(width)} ${n(height)}" ` +
      `font-family="${FAMILY}"><title>${escaped(title)}</title><rect width="100%" height="100%" fill="#ffffff"/>\n` +
      `${this.out.join("\n")}${"</g>".repeat(this.opened)}</svg>\n`
    );
  }

  save(): void {
    this.saved.push(Object.fromEntries(STATE.map((key) => [key, this[key]])));
    this.opened = 0;
  }

  restore(): void {
    const state = this.saved.pop();
    if (!state) return;
    if (this.opened) this.out.push("</g>".repeat(this.opened));
    Object.assign(this, state);
  }

  translate(x: number, y: number): void {
    this.open(`transform="translate(${n(x)} ${n(y)})"`);
  }

  rotate(angle: number): void {
    this.open(`transform="rotate(${n((angle * 180) / Math.PI)})"`);
  }

  setLineDash(dashes: number[]): void {
    this.dashes = dashes.join(" ");
  }

  beginPath(): void {
    this.path = "";
  }

  closePath(): void {
    if (this.path) this.path += "z";
  }

  moveTo(x: number, y: number): void {
    if (allFinite(x, y)) this.path += `M${n(x)} ${n(y)}`;
  }

  lineTo(x: number, y: number): void {
    if (allFinite(x, y)) this.path += `${this.path ? "L" : "M"}${n(x)} ${n(y)}`;
  }

  rect(x: number, y: number, width: number, height: number): void {
    if (allFinite(x, y, width, height)) this.path += `M${n(x)} ${n(y)}h${n(width)}v${n(height)}h${n(-width)}z`;
  }

  arc(x: number, y: number, radius: number, from: number, to: number): void {
    if (!allFinite(x, y, radius)) return;
    this.lineTo(x + radius * Math.cos(from), y + radius * Math.sin(from));
    // in two halves, for a whole circle ends where it begins
    for (const angle of [(from + to) / 2, to])
      this.path += `A${n(radius)} ${n(radius)} 0 0 1 ${n(x + radius * Math.cos(angle))} ${n(y + radius * Math.sin(angle))}`;
  }

  fill(rule?: CanvasFillRule): void {
    if (!this.path) return;
    this.out.push(`<path d="${this.path}" ${this.filled()}${rule === "evenodd" ? ' fill-rule="evenodd"' : ""}/>`);
  }

  stroke(): void {
    if (!this.path) return;
    const dashes = this.dashes ? ` stroke-dasharray="${this.dashes}"` : "";
    const stroke = svgPaint("stroke", String(this.strokeStyle), this.globalAlpha);
    this.out.push(
      `<path d="${this.path}" fill="none" ${stroke} stroke-width="${n(this.lineWidth)}" stroke-linejoin="${this.lineJoin}"${dashes}/>`,
    );
  }

  clip(): void {
    this.clips += 1;
    this.out.push(`<clipPath id="clip${this.clips}"><path d="${this.path}"/></clipPath>`);
    this.open(`clip-path="url(#clip${this.clips})"`);
  }

  fillRect(x: number, y: number, width: number, height: number): void {
    if (!allFinite(x, y, width, height) || width === 0 || height === 0) return;
    const place = `x="${n(Math.min(x, x + width))}" y="${n(Math.min(y, y + height))}"`;
    this.out.push(`<rect ${place} width="${n(Math.abs(width))}" height="${n(Math.abs(height))}" ${this.filled()}/>`);
  }

  fillText(text: string, x: number, y: number, maxWidth = Number.POSITIVE_INFINITY): void {
    if (!allFinite(x, y)) return;
    this.out.push(svgText(text, n(x), y, maxWidth, this, this.filled()));
  }

  measureText(text: string): { width: number } {
    return { width: widthIn(this.font, text) };
  }

  private filled(): string {
    return svgPaint("fill", String(this.fillStyle), this.globalAlpha);
  }

  private open(attributes: string): void {
    this.out.push(`<g ${attributes}>`);
    this.opened += 1;
  }
}

/** A CSS colour as SVG writes it: `#rrggbb` and an opacity, because not every program reads both in one. */
export function svgColour(css: string): { colour: string; opacity: number } {
  if (css.startsWith("#"))
    return { colour: css.slice(0, 7), opacity: css.length > 7 ? Number.parseInt(css.slice(7), 16) / 255 : 1 };
  const [r, g, b, opacity = 1] = [...css.matchAll(/-?[\d.]+(?:e-?\d+)?/g)].map(Number);
  if (b === undefined) return { colour: css, opacity: 1 };
  const whole = css.startsWith("color(") ? 255 : 1;
  const hex = [r, g, b].map((part) =>
    Math.round(part * whole)
      .toString(16)
      .padStart(2, "0"),
  );
  return { colour: `#${hex.join("")}`, opacity };
}

/** The attributes of a fill or a stroke. */
function svgPaint(kind: "fill" | "stroke", css: string, alpha = 1): string {
  const { colour, opacity } = svgColour(css);
  const seen = Math.round(opacity * alpha * 1000) / 1000;
  return `${kind}="${colour}"${seen < 1 ? ` ${kind}-opacity="${seen}"` : ""}`;
}
