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
export function svgPaint(kind: "fill" | "stroke", css: string, alpha = 1): string {
  const { colour, opacity } = svgColour(css);
  const seen = Math.round(opacity * alpha * 1000) / 1000;
  return `${kind}="${colour}"${seen < 1 ? ` ${kind}-opacity="${seen}"` : ""}`;
}
