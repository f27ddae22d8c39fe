import palette from "../../../scenarios/report/palette.json";

export type Scheme = "dark" | "light";

/**
 * Okabe and Ito's colours in the order traces take them; on white the pale ones are darkened to stay visible.
 * Slot 0 is the neutral one: what should be. Reports have the same.
 */
export const TRACE_COLOURS: Record<Scheme, readonly string[]> = palette.colours;

/** Dashes in device-independent pixels; the first is solid. */
export const DASHES: readonly (readonly number[])[] = palette.dashes;

/** Slots of hypotheses, in their order. */
export const HYPOTHESES: readonly number[] = palette.hypotheses;

/** Slot and dash of the signals everybody looks at: colours that can be remembered. */
export const SIGNALS: Partial<Record<string, readonly number[]>> = palette.signals;

/** Canvas colours that CSS cannot reach; the rest are tokens in theme.css. */
export const CANVAS = {
  dark: {
    panel: "#161b21",
    text: "#e8ecf1",
    muted: "#9aa6b4",
    grid: "#262e37",
    axis: "#3a4552",
    accent: "#8fb0ff",
    alarm: "#ff6b60",
    event: "#7d8b9b",
  },
  light: {
    panel: "#ffffff",
    text: "#1a1f26",
    muted: "#56616e",
    grid: "#e6eaee",
    axis: "#b9c2cc",
    accent: "#2c55c8",
    alarm: "#c4261d",
    event: "#7a8795",
  },
} satisfies Record<Scheme, Record<string, string>>;

const parts = (colour: string) => [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16));

/** The share of a colour in a trace behind others. */
const LEFT = 0.45;

/** The colour of a share from 0 to 1 of a scale: lighter and lighter on dark, darker on light, in every kind of sight. */
export function rampColour(share: number, scheme: Scheme): string {
  const stops = palette.ramp[scheme].map(parts);
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const from = Math.min(Math.floor(at), stops.length - 2);
  const mixed = stops[from].map((value, i) => Math.round(value + (stops[from + 1][i] - value) * (at - from)));
  return `rgb(${mixed.join(" ")})`;
}

/** The colour of a trace behind others, on the panels of a scheme. */
export function faded(colour: string, scheme: Scheme): string {
  const ground = parts(CANVAS[scheme].panel);
  const mixed = parts(colour).map((part, i) => Math.round(LEFT * part + (1 - LEFT) * ground[i]));
  return `#${mixed.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
}

/** Font for text on a canvas, in device pixels. */
export function fontFor(size: number, ratio: number, weight = 450): string {
  return `${weight} ${size * ratio}px "IBM Plex Sans Variable", system-ui, sans-serif`;
}

/** WCAG contrast ratio of two #rrggbb colours. */
export function contrast(a: string, b: string): number {
  const [x, y] = [luminance(a), luminance(b)].sort((p, q) => q - p);
  return (x + 0.05) / (y + 0.05);
}

const INKS = ["#0b0e12", "#ffffff"];

/** The ink, dark or light, that reads better on a colour. */
export function inkOn(colour: string): string {
  return contrast(INKS[0], colour) >= contrast(INKS[1], colour) ? INKS[0] : INKS[1];
}

function luminance(hex: string): number {
  const [r, g, b] = [1, 3, 5].map((i) => {
    const c = Number.parseInt(hex.slice(i, i + 2), 16) / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
