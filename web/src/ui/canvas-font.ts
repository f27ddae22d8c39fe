/** Font for text on a canvas, in device pixels. */
export function fontFor(size: number, ratio: number, weight = 450): string {
  return `${weight} ${size * ratio}px "IBM Plex Sans Variable", system-ui, sans-serif`;
}
