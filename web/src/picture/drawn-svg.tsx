import type { ReactElement } from "react";
import { flushSync } from "react-dom";
import { createRoot } from "react-dom/client";
import { roundTo } from "../ui/unit-scale";
import { svgColour } from "./svg-colour";
import { FAMILY } from "./svg-text";

const PAINTS = ["fill", "stroke"] as const;
/** What else a style sheet may say of a shape, and what need not be said. */
const USUAL: Record<string, string> = {
  opacity: "1",
  "stroke-width": "1px",
  "stroke-dasharray": "none",
  "stroke-linecap": "butt",
  "stroke-linejoin": "miter",
};

/** The inside of an <svg> that React draws, in light colours, with its style sheet written into its shapes. */
export function drawnSvg(chart: ReactElement): string {
  const host = document.createElement("div");
  host.dataset.mantineColorScheme = "light";
  host.style.cssText = `position: fixed; visibility: hidden; --size-0: 12px; --size-1: 13px; --font: ${FAMILY}`;
  document.body.append(host);
  const root = createRoot(host);
  try {
    flushSync(() => root.render(chart));
    const svg = host.querySelector("svg");
    if (!svg) throw new Error("the chart drew nothing");
    for (const shape of svg.querySelectorAll<SVGElement>("*")) writeStyle(shape);
    return new XMLSerializer().serializeToString(svg).replace(/^<svg[^>]*>|<\/svg>$/g, "");
  } finally {
    root.unmount();
    host.remove();
  }
}

function writeStyle(shape: SVGElement): void {
  if (shape.nodeName !== "g") {
    const style = getComputedStyle(shape);
    for (const kind of PAINTS) {
      const value = style.getPropertyValue(kind);
      const { colour, opacity } = svgColour(value || "none");
      shape.setAttribute(kind, colour);
      if (opacity < 1) shape.setAttribute(`${kind}-opacity`, `${roundTo(opacity, 3)}`);
    }
    for (const [name, usual] of Object.entries(USUAL)) {
      const value = style.getPropertyValue(name);
      if (value && value !== usual) shape.setAttribute(name, value);
    }
    if (shape.nodeName === "text") {
      shape.setAttribute("font-size", style.fontSize.replace("px", ""));
      shape.setAttribute("font-weight", String(Math.floor(Number(style.fontWeight) / 100) * 100));
    }
  }
  shape.removeAttribute("class");
}
