const cache = new Map<string, CanvasPattern | null>();

/** A diagonal hatch of a colour: a guess, as against the solid of what is known. */
export function hatch(ctx: CanvasRenderingContext2D, colour: string): CanvasPattern | string {
  let pattern = cache.get(colour);
  if (pattern === undefined) {
    const tile = document.createElement("canvas");
    tile.width = tile.height = 8;
    const t = tile.getContext("2d");
    if (t) {
      t.fillStyle = `${colour}40`;
      t.fillRect(0, 0, 8, 8);
      t.strokeStyle = colour;
      t.lineWidth = 2.4;
      t.beginPath();
      for (const shift of [-8, 0, 8]) {
        t.moveTo(shift - 1, 9);
        t.lineTo(shift + 9, -1);
      }
      t.stroke();
    }
    pattern = ctx.createPattern(tile, "repeat");
    cache.set(colour, pattern);
  }
  return pattern ?? colour;
}
