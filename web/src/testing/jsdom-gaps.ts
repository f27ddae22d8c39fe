/** Parts of a browser that the page uses and jsdom lacks. The set-up file loads this module before any other. */
import { act } from "@testing-library/react";
import { penOf } from "./recording-pen";

const USUAL = { width: 800, height: 400 };

let size = USUAL;
const observers = new Set<FakeResizeObserver>();
const frames = new Map<number, FrameRequestCallback>();
let lastFrame = 0;

/** Draw one picture of the screen: every callback that waits for an animation frame runs once. */
export const drawOnce = (): Promise<void> =>
  act(async () => {
    const due = [...frames.values()];
    frames.clear();
    for (const draw of due) draw(performance.now());
  });

/** Give every element another size, px, and tell the observers. An element with a width in its style keeps this width. */
export function resize(width: number, height: number): void {
  size = { width, height };
  act(() => {
    for (const observer of [...observers]) observer.tell();
  });
}

/** Back to the usual size, with no picture under way. */
export function resetScreen(): void {
  size = USUAL;
  frames.clear();
}

const styled = (element: Element, side: "width" | "height"): number =>
  Number.parseFloat((element as HTMLElement).style?.[side]?.match(/^[\d.]+px$/)?.[0] ?? "") || size[side];

const boxOf = (element: Element): DOMRect => {
  const [width, height] = [styled(element, "width"), styled(element, "height")];
  const box = { x: 0, y: 0, left: 0, top: 0, right: width, bottom: height, width, height };
  return { ...box, toJSON: () => box };
};

/** Tells the size of an element when it begins to watch, and after each `resize`. */
class FakeResizeObserver implements ResizeObserver {
  private readonly watched = new Set<Element>();
  private readonly heard: ResizeObserverCallback;

  constructor(heard: ResizeObserverCallback) {
    this.heard = heard;
  }

  observe(element: Element): void {
    observers.add(this);
    this.watched.add(element);
    this.tell([element]);
  }

  unobserve(element: Element): void {
    this.watched.delete(element);
  }

  disconnect(): void {
    observers.delete(this);
    this.watched.clear();
  }

  tell(elements: Iterable<Element> = this.watched): void {
    const entries = [...elements].map((target) => ({ target, contentRect: boxOf(target) }) as ResizeObserverEntry);
    this.heard(entries, this);
  }
}

/** Every element is in sight. */
class FakeIntersectionObserver {
  private readonly heard: IntersectionObserverCallback;

  constructor(heard: IntersectionObserverCallback) {
    this.heard = heard;
  }

  observe(target: Element): void {
    this.heard([{ target, isIntersecting: true } as IntersectionObserverEntry], this as never);
  }

  unobserve(): void {}
  disconnect(): void {}
}

class FakeImageData {
  readonly colorSpace = "srgb";
  readonly data: Uint8ClampedArray;
  readonly width: number;
  readonly height: number;

  constructor(width: number, height: number) {
    this.width = width;
    this.height = height;
    this.data = new Uint8ClampedArray(4 * width * height);
  }
}

/** An address of the page may be relative, which Node's own request refuses. */
class PageRequest extends Request {
  constructor(input: RequestInfo | URL, init?: RequestInit) {
    super(input instanceof Request ? input : new URL(input, document.baseURI), init);
  }
}

/** An element of a formula, which has no style in jsdom, has the style of the page. */
const styleOf = globalThis.getComputedStyle;
const formulaStyle: typeof styleOf = (element, pseudo) =>
  styleOf("style" in element ? element : document.documentElement, pseudo);

const noMedia = (media: string) =>
  ({
    media,
    matches: false,
    addEventListener() {},
    removeEventListener() {},
    addListener() {},
    removeListener() {},
  }) as never;

fillGaps();

function fillGaps(): void {
  Object.assign(globalThis, {
    ResizeObserver: FakeResizeObserver,
    IntersectionObserver: FakeIntersectionObserver,
    ImageData: FakeImageData,
    Request: PageRequest,
    matchMedia: noMedia,
    getComputedStyle: formulaStyle,
    scrollTo: () => undefined,
    requestAnimationFrame: (draw: FrameRequestCallback) => {
      frames.set(++lastFrame, draw);
      return lastFrame;
    },
    cancelAnimationFrame: (frame: number) => frames.delete(frame),
  });
  Object.defineProperty(document, "fonts", {
    value: { status: "loaded", ready: Promise.resolve(), addEventListener() {}, removeEventListener() {} },
  });
  const create = document.createElement.bind(document);
  // a tag that is newer than jsdom
  document.createElement = (name: string, options?: ElementCreationOptions): HTMLElement =>
    Object.defineProperties(create(name, options), name === "search" ? { [Symbol.toStringTag]: { value: name } } : {});
  const held = new WeakMap<Element, number>();
  Object.assign(Blob.prototype, {
    text(this: Blob) {
      return new Promise((done) => {
        const reader = new FileReader();
        reader.onload = () => done(reader.result);
        reader.readAsText(this);
      });
    },
  });
  Object.assign(Element.prototype, {
    scrollIntoView: () => undefined,
    scrollTo: () => undefined,
    setPointerCapture(this: Element, pointer: number) {
      held.set(this, pointer);
    },
    hasPointerCapture(this: Element, pointer: number) {
      return held.get(this) === pointer;
    },
    releasePointerCapture(this: Element) {
      held.delete(this);
    },
    getBoundingClientRect(this: Element) {
      return boxOf(this);
    },
  });
  Object.defineProperties(Element.prototype, {
    clientWidth: { configurable: true, get: (): number => 0 },
    clientHeight: { configurable: true, get: (): number => 0 },
  });
  Object.defineProperties(HTMLElement.prototype, {
    clientWidth: {
      configurable: true,
      get(this: HTMLElement) {
        return styled(this, "width");
      },
    },
    clientHeight: {
      configurable: true,
      get(this: HTMLElement) {
        return styled(this, "height");
      },
    },
  });
  Object.assign(HTMLCanvasElement.prototype, {
    getContext(this: HTMLCanvasElement, kind: string) {
      return kind === "2d" ? penOf(this) : null;
    },
  });
}
