import { type Span, zoomSpan } from "./use-time-view";

export interface ScopeGestures {
  /** The span moved under the hand; ticks. */
  onSpan(start: number, end: number): void;
  onLive(): void;
  /** Pressed and released in one place. */
  onClick?(tick: number): void;
}

const WHEEL_STEP = 1.2;
/** Pixels a hand moves without meaning to. */
const STILL_PX = 3;

/** Drag pans, wheel zooms about the pointer, two fingers pinch, double click goes live. Returns how to stop. */
export function listenForGestures(over: HTMLElement, gestures: ScopeGestures, span: () => Span): () => void {
  const stop = new AbortController();
  const on = <K extends keyof HTMLElementEventMap>(kind: K, heard: (event: HTMLElementEventMap[K]) => void) =>
    over.addEventListener(kind, heard, { signal: stop.signal, passive: false });
  const pointers = new Map<number, number>();
  let grabbed: Span | undefined;
  let grabbedAt: number[] = [];
  let moved = false;

  const tickAt = (x: number, s: Span) => s.start + (x / over.clientWidth) * (s.end - s.start);
  const grab = () => {
    grabbed = { ...span() };
    grabbedAt = [...pointers.values()];
  };

  on("pointerdown", (event) => {
    if (event.button !== 0) return;
    over.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, event.offsetX);
    moved = pointers.size > 1;
    grab();
  });
  on("pointermove", (event) => {
    if (!grabbed || !pointers.has(event.pointerId)) return;
    pointers.set(event.pointerId, event.offsetX);
    const xs = [...pointers.values()];
    if (!moved && xs.length === 1 && Math.abs(xs[0] - grabbedAt[0]) < STILL_PX) return;
    moved = true;
    if (xs.length >= 2) {
      const zoom = Math.max(10, Math.abs(grabbedAt[1] - grabbedAt[0])) / Math.max(10, Math.abs(xs[1] - xs[0]));
      const next = zoomSpan(grabbed.start, grabbed.end, tickAt((grabbedAt[0] + grabbedAt[1]) / 2, grabbed), zoom);
      gestures.onSpan(next.start, next.end);
      return;
    }
    const shift = tickAt(grabbedAt[0], grabbed) - tickAt(xs[0], grabbed);
    gestures.onSpan(grabbed.start + shift, grabbed.end + shift);
  });
  const release = (event: PointerEvent) => {
    pointers.delete(event.pointerId);
    if (pointers.size) grab();
    else grabbed = undefined;
  };
  on("pointerup", (event) => {
    release(event);
    if (!moved && event.button === 0) gestures.onClick?.(tickAt(event.offsetX, span()));
  });
  on("pointercancel", release);
  on("wheel", (event) => {
    event.preventDefault();
    const now = span();
    if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
      const shift = (Math.sign(event.deltaX || event.deltaY) * (now.end - now.start)) / 12;
      gestures.onSpan(now.start + shift, now.end + shift);
      return;
    }
    const zoom = event.deltaY > 0 ? WHEEL_STEP : 1 / WHEEL_STEP;
    const next = zoomSpan(now.start, now.end, tickAt(event.offsetX, now), zoom);
    gestures.onSpan(next.start, next.end);
  });
  on("dblclick", gestures.onLive);
  return () => stop.abort();
}
