const FULL = 255;

/**
 * Upright bars written into pixels: a scope has thousands of them a frame.
 *
 * It takes the calls of a canvas and leaves the same pixels. A canvas without a graphics card keeps a list of all fills and
 * works through it at the end of the frame, which takes several times as long.
 */
export class BarRaster {
  image = new ImageData(1, 1);
  /** Nothing was filled since it was cleared. */
  isEmpty = true;
  private pixels = new Uint32Array(this.image.data.buffer);
  /** Blue, green and red, as pixels have them below their alpha. */
  private colour = 0;

  /** Begin anew with this size. */
  clear(width: number, height: number): void {
    if (this.image.width !== width || this.image.height !== height) {
      this.image = new ImageData(width, height);
      this.pixels = new Uint32Array(this.image.data.buffer);
    } else if (!this.isEmpty) this.pixels.fill(0);
    this.isEmpty = true;
  }

  /** #rrggbb. */
  set fillStyle(hex: string) {
    const rgb = Number.parseInt(hex.slice(1), 16);
    this.colour = ((rgb & FULL) << 16) | (rgb & (FULL << 8)) | (rgb >>> 16);
  }

  /** Fill whole columns from a height to another; the pixels at both ends as far as they are covered. */
  fillRect(x: number, y: number, width: number, height: number): void {
    const { pixels } = this;
    const { width: stride, height: rows } = this.image;
    const right = Math.min(stride, x + width);
    const top = Math.max(0, y);
    const bottom = Math.min(rows, y + height);
    if (top >= bottom) return;
    this.isEmpty = false;
    const first = Math.ceil(top);
    const last = Math.floor(bottom);
    const solid = (FULL << 24) | this.colour;
    for (let column = Math.max(0, x); column < right; column += 1) {
      const end = last * stride + column;
      for (let at = first * stride + column; at < end; at += stride) pixels[at] = solid;
      if (last < first) this.cover(end, bottom - top);
      else {
        if (top < first) this.cover((first - 1) * stride + column, first - top);
        if (last < bottom) this.cover(end, bottom - last);
      }
    }
  }

  /** Lay the colour over a share of a pixel. */
  private cover(at: number, share: number): void {
    const under = this.pixels[at];
    const alpha = share * FULL + (under >>> 24) * (1 - share);
    const part = (share * FULL) / alpha;
    const { colour } = this;
    this.pixels[at] =
      (Math.round(alpha) << 24) |
      (mix(under >>> 16, colour >>> 16, part) << 16) |
      (mix(under >>> 8, colour >>> 8, part) << 8) |
      mix(under, colour, part);
  }
}

/** Between two channels, the lowest eight bits of each. */
const mix = (under: number, over: number, part: number) =>
  Math.round((under & FULL) + ((over & FULL) - (under & FULL)) * part);
