import { beforeAll, expect, it, vi } from "vitest";
import { BarRaster } from "./bar-raster";

/** An image as a canvas keeps it: its size, and red, green, blue and alpha of each pixel. */
class Image {
  readonly data: Uint8ClampedArray;
  readonly width: number;
  readonly height: number;
  constructor(width: number, height: number) {
    this.width = width;
    this.height = height;
    this.data = new Uint8ClampedArray(4 * width * height);
  }
}

beforeAll(() => {
  vi.stubGlobal("ImageData", Image);
});

const WIDTH = 7;
const HEIGHT = 9;
type Bar = { colour: string; box: [x: number, y: number, width: number, height: number] };

const raster = (bars: Bar[]) => {
  const made = new BarRaster();
  made.clear(WIDTH, HEIGHT);
  for (const { colour, box } of bars) {
    made.fillStyle = colour;
    made.fillRect(...box);
  }
  return made;
};

/** The same by the definition: the share of each pixel under each bar, bar after bar. */
function oracle(bars: Bar[]): number[] {
  return Array.from({ length: WIDTH * HEIGHT }, (_, at) => {
    const [column, row] = [at % WIDTH, Math.floor(at / WIDTH)];
    let [red, green, blue, alpha] = [0, 0, 0, 0]; // multiplied by alpha
    for (const { colour, box } of bars) {
      const [x, y, width, height] = box;
      if (column < x || column >= x + width) continue;
      const share = Math.max(0, Math.min(row + 1, y + height) - Math.max(row, y));
      const over = [1, 3, 5].map((i) => Number.parseInt(colour.slice(i, i + 2), 16) * share);
      [red, green, blue] = [red, green, blue].map((under, i) => over[i] + under * (1 - share));
      alpha = share + alpha * (1 - share);
    }
    return alpha ? [red / alpha, green / alpha, blue / alpha, 255 * alpha] : [0, 0, 0, 0];
  }).flat();
}

/** Reproducible numbers from 0 to 1. */
function* numbers(seed: number): Generator<number, never> {
  for (let state = seed; ; ) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    yield state / 2 ** 32;
  }
}

it("leaves the pixels that the bars cover, as far as they cover them", () => {
  const random = numbers(7);
  const next = () => random.next().value;
  for (let round = 0; round < 300; round += 1) {
    const bars = Array.from({ length: 6 }, (): Bar => {
      const colour = `#${Math.floor(next() * 2 ** 24)
        .toString(16)
        .padStart(6, "0")}`;
      const x = Math.floor(next() * (WIDTH + 4)) - 2;
      return { colour, box: [x, next() * 14 - 3, 1 + Math.floor(next() * 2), next() * 8] };
    });
    const { data } = raster(bars).image;
    const expected = oracle(bars);
    expected.forEach((value, i) => {
      // a pixel that is hardly covered keeps its colour in few steps
      const alpha = expected[i - (i % 4) + 3];
      const off = i % 4 === 3 ? 3 : 4 + 400 / Math.max(1, alpha);
      if (alpha > 2) expect(Math.abs(data[i] - value)).toBeLessThanOrEqual(off);
    });
  }
});

it("has the very colour where a bar is whole, red first", () => {
  const { data } = raster([{ colour: "#12ab9f", box: [2, 1, 1, 3] }]).image;
  expect([...data.slice(4 * (2 * WIDTH + 2), 4 * (2 * WIDTH + 3))]).toEqual([0x12, 0xab, 0x9f, 255]);
  expect(data.filter((value, i) => i % 4 === 3 && value > 0)).toHaveLength(3);
});

it("is empty again once it is cleared, at any size", () => {
  const made = raster([{ colour: "#ffffff", box: [0, 0, WIDTH, HEIGHT] }]);
  expect(made.isEmpty).toBe(false);
  made.clear(WIDTH, HEIGHT);
  expect(made.isEmpty).toBe(true);
  expect(made.image.data.every((value) => value === 0)).toBe(true);
  made.fillRect(0, 0, 1, 1);
  made.clear(3, 2);
  expect(made.image.data).toHaveLength(24);
  made.fillRect(0, 5, 1, 1);
  expect(made.isEmpty).toBe(true);
});
