let ruler: CanvasRenderingContext2D | null | undefined;

/** Width of a line of text, px; without a canvas, that of letters of a usual width. */
export function textWidth(text: string, size: number, weight: number, family: string): number {
  if (ruler === undefined) ruler = document.createElement("canvas").getContext("2d") ?? null;
  if (!ruler) return 0.55 * size * text.length;
  ruler.font = `${weight} ${size}px ${family}`;
  return ruler.measureText(text).width;
}
