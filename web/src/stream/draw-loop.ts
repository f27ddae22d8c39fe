type Painter = () => void;

/** The one animation loop of the page: painters run once per display frame, in the order they joined. */
export class DrawLoop {
  /** When the last frame was drawn, on `performance.now()`'s clock. */
  lastFrame = performance.now();
  private readonly painters = new Set<Painter>();
  private request = 0;

  add(painter: Painter): () => void {
    this.painters.add(painter);
    if (!this.request) this.request = requestAnimationFrame(this.frame);
    return () => {
      this.painters.delete(painter);
    };
  }

  private readonly frame = (): void => {
    this.lastFrame = performance.now();
    for (const painter of this.painters) {
      try {
        painter();
      } catch (error) {
        // the others continue without it
        this.painters.delete(painter);
        reportError(error);
      }
    }
    this.request = this.painters.size ? requestAnimationFrame(this.frame) : 0;
  };
}
