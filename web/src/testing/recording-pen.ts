import type { Pen } from "../picture/pen";

export type Point = readonly [x: number, y: number];

/** A painted mark: its place on the canvas, px, and its style. */
export interface Mark {
  kind: "line" | "area" | "rect" | "text" | "image";
  colour: string;
  /** Corners of a line, an area or a rectangle; the place of a text or an image. */
  points: Point[];
  width: number;
  dashes: number[];
  alpha: number;
  font: string;
  align: CanvasTextAlign;
  text: string;
  image: ImageData | undefined;
}

type Matrix = [number, number, number, number, number, number];

/** Of letters, in sizes of the font. */
const LETTER = 0.55;
const CORNERS = 24;

/** A pen that paints nothing and lists the marks of the present picture, since the canvas was cleared. */
export class RecordingPen implements Pen {
  readonly canvas: HTMLCanvasElement;
  /** All of the picture, in the order it was painted. */
  marks: Mark[] = [];
  fillStyle: Pen["fillStyle"] = "#000000";
  strokeStyle: Pen["strokeStyle"] = "#000000";
  lineWidth = 1;
  lineJoin: CanvasLineJoin = "miter";
  lineCap: CanvasLineCap = "butt";
  font = "10px sans-serif";
  textAlign: CanvasTextAlign = "start";
  textBaseline: CanvasTextBaseline = "alphabetic";
  globalAlpha = 1;
  private dashes: number[] = [];
  private matrix: Matrix = [1, 0, 0, 1, 0, 0];
  private path: { points: Point[]; isRect: boolean }[] = [];
  private readonly saved: object[] = [];

  constructor(canvas: HTMLCanvasElement = document.createElement("canvas")) {
    this.canvas = canvas;
  }

  /** The texts with their places and colours. */
  get texts(): Mark[] {
    return this.marks.filter(({ kind }) => kind === "text");
  }

  /** The words of the texts. */
  get words(): string[] {
    return this.texts.map(({ text }) => text);
  }

  /** Stroked lines, of one colour if it is given. */
  lines = (colour?: string): Mark[] => this.of("line", colour);

  /** Filled areas other than rectangles, of one colour if it is given. */
  areas = (colour?: string): Mark[] => this.of("area", colour);

  /** Filled rectangles, of one colour if it is given. */
  rects = (colour?: string) => this.of("rect", colour).map((mark) => ({ ...mark, ...extentOf([mark]) }));

  /** Pixels that were put there. */
  get images(): ImageData[] {
    return this.marks.flatMap(({ image }) => image ?? []);
  }

  /** The box around all marks, px. */
  get extent() {
    return extentOf(this.marks);
  }

  save(): void {
    const { fillStyle, strokeStyle, lineWidth, lineJoin, lineCap, font, textAlign, textBaseline, globalAlpha } = this;
    const style = { fillStyle, strokeStyle, lineWidth, lineJoin, lineCap, font, textAlign, textBaseline, globalAlpha };
    this.saved.push({ ...style, dashes: this.dashes, matrix: this.matrix });
  }

  restore(): void {
    Object.assign(this, this.saved.pop());
  }

  setTransform(...matrix: Matrix): void {
    this.matrix = matrix;
  }

  transform(a: number, b: number, c: number, d: number, e: number, f: number): void {
    const [A, B, C, D, E, F] = this.matrix;
    this.matrix = [A * a + C * b, B * a + D * b, A * c + C * d, B * c + D * d, A * e + C * f + E, B * e + D * f + F];
  }

  translate(x: number, y: number): void {
    this.transform(1, 0, 0, 1, x, y);
  }

  scale(x: number, y: number): void {
    this.transform(x, 0, 0, y, 0, 0);
  }

  rotate(angle: number): void {
    this.transform(Math.cos(angle), Math.sin(angle), -Math.sin(angle), Math.cos(angle), 0, 0);
  }

  setLineDash(dashes: number[]): void {
    this.dashes = dashes;
  }

  beginPath(): void {
    this.path = [];
  }

  closePath(): void {
    const part = this.path.at(-1);
    if (part) part.points.push(part.points[0]);
  }

  moveTo(x: number, y: number): void {
    this.path.push({ points: [this.at(x, y)], isRect: false });
  }

  lineTo(x: number, y: number): void {
    if (this.path.length === 0) this.moveTo(x, y);
    else this.path[this.path.length - 1].points.push(this.at(x, y));
  }

  rect(x: number, y: number, width: number, height: number): void {
    this.path.push({ points: this.corners(x, y, width, height), isRect: true });
  }

  arc(x: number, y: number, radius: number, from: number, to: number): void {
    for (let i = 0; i <= CORNERS; i += 1) {
      const angle = from + ((to - from) * i) / CORNERS;
      const place = [x + radius * Math.cos(angle), y + radius * Math.sin(angle)] as const;
      if (i === 0 && this.path.length === 0) this.moveTo(...place);
      else this.lineTo(...place);
    }
  }

  clip(): void {}

  fill(): void {
    for (const { points, isRect } of this.path) this.mark(isRect ? "rect" : "area", points, this.fillStyle);
  }

  stroke(): void {
    for (const { points } of this.path) this.mark("line", points, this.strokeStyle);
  }

  fillRect(x: number, y: number, width: number, height: number): void {
    this.mark("rect", this.corners(x, y, width, height), this.fillStyle);
  }

  /** Clearing all of the canvas begins a new picture. */
  clearRect(x: number, y: number, width: number, height: number): void {
    const { left, right, top, bottom } = extentOf([{ points: this.corners(x, y, width, height) }]);
    if (left <= 0 && top <= 0 && right >= this.canvas.width && bottom >= this.canvas.height) this.marks = [];
  }

  fillText(text: string, x: number, y: number): void {
    this.mark("text", [this.at(x, y)], this.fillStyle, { text });
  }

  measureText(text: string): { width: number } {
    return { width: text.length * LETTER * (Number.parseFloat(/([\d.]+)px/.exec(this.font)?.[1] ?? "") || 10) };
  }

  createImageData(width: number, height: number): ImageData {
    return new ImageData(width, height);
  }

  putImageData(image: ImageData, x: number, y: number): void {
    this.mark("image", [[x, y]], "", { image: copied(image) });
  }

  /** Put the pixels of another canvas here. */
  drawImage(canvas: CanvasImageSource, x: number, y: number): void {
    const image = canvas instanceof HTMLCanvasElement ? penOf(canvas).images.at(-1) : undefined;
    this.mark("image", [this.at(x, y)], "", { image });
  }

  private of(kind: Mark["kind"], colour: string | undefined): Mark[] {
    return this.marks.filter((mark) => mark.kind === kind && (colour === undefined || mark.colour === colour));
  }

  private mark(kind: Mark["kind"], points: Point[], style: Pen["fillStyle"], own: Partial<Mark> = {}): void {
    const { lineWidth: width, globalAlpha: alpha, font, textAlign: align } = this;
    const dashes = this.dashes;
    const colour = typeof style === "string" ? style : "";
    this.marks.push({ kind, colour, points, width, dashes, alpha, font, align, text: "", image: undefined, ...own });
  }

  private at(x: number, y: number): Point {
    const [a, b, c, d, e, f] = this.matrix;
    return [a * x + c * y + e, b * x + d * y + f];
  }

  private corners(x: number, y: number, width: number, height: number): Point[] {
    const [right, bottom] = [x + width, y + height];
    return [this.at(x, y), this.at(right, y), this.at(right, bottom), this.at(x, bottom)];
  }
}

const pens = new WeakMap<HTMLCanvasElement, RecordingPen>();

/** The pen of a canvas, or of the first canvas in an element. */
export function penOf(element: Element): RecordingPen {
  const canvas = element instanceof HTMLCanvasElement ? element : element.querySelector("canvas");
  if (!canvas) throw new Error("there is no canvas in this element");
  const pen = pens.get(canvas) ?? new RecordingPen(canvas);
  pens.set(canvas, pen);
  return pen;
}

/** How many pixels of an image have a colour (#rrggbb) and can be seen. */
export function pixelsOf(image: ImageData, colour: string): number {
  const [red, green, blue] = [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16));
  let found = 0;
  for (let i = 0; i < image.data.length; i += 4) {
    const [r, g, b, alpha] = image.data.subarray(i, i + 4);
    if (r === red && g === green && b === blue && alpha > 0) found += 1;
  }
  return found;
}

function copied(image: ImageData): ImageData {
  const copy = new ImageData(image.width, image.height);
  copy.data.set(image.data);
  return copy;
}

function extentOf(marks: readonly Pick<Mark, "points">[]) {
  const points = marks.flatMap((mark) => mark.points);
  const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
  return { left: least(xs), right: most(xs), top: least(ys), bottom: most(ys) };
}

const least = (values: number[]) => values.reduce((a, b) => Math.min(a, b), Number.POSITIVE_INFINITY);
const most = (values: number[]) => values.reduce((a, b) => Math.max(a, b), Number.NEGATIVE_INFINITY);
