type Painter = () => void;

/** The one animation loop of the page: painters run once per display frame, in the order they joined. */
export class DrawLoop {
  private readonly painters = new Set<Painter>();
  private request = 0;
  /** Frames drawn in the last full second, for the status strip. */
  framesPerSecond = 0;
  /** When the last frame was drawn, on `performance.now()`'s clock. */
  lastFrame = performance.now();
  private counted = 0;
  private since = 0;

  add(painter: Painter): () => void {
    this.painters.add(painter);
    if (!this.request) this.request = requestAnimationFrame(this.frame);
    return () => {
      this.painters.delete(painter);
    };
  }

  private readonly frame = (now: number): void => {
    this.lastFrame = performance.now();
    this.counted += 1;
    if (now - this.since >= 1000) {
      this.framesPerSecond = Math.round((this.counted * 1000) / (now - this.since));
      this.counted = 0;
      this.since = now;
    }
    for (const painter of this.painters) painter();
    this.request = this.painters.size ? requestAnimationFrame(this.frame) : 0;
  };
}
