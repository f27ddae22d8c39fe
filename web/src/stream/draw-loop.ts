import { Strain } from "./strain";

type Painter = () => void;

/** The one animation loop of the page: painters run once per display frame, in the order they joined. */
export class DrawLoop {
  /** When the last frame was drawn, on `performance.now()`'s clock. */
  lastFrame = performance.now();
  private readonly painters = new Set<Painter>();
  private readonly strain = new Strain();
  private request = 0;
  private counted = 0;
  private since = performance.now();

  /** Whether drawing should be simpler to keep up. */
  get strained(): boolean {
    return this.strain.strained;
  }

  add(painter: Painter): () => void {
    this.painters.add(painter);
    if (!this.request) this.request = requestAnimationFrame(this.frame);
    return () => {
      this.painters.delete(painter);
    };
  }

  private readonly frame = (): void => {
    const now = performance.now();
    // A covered window gets few frames or none; that is no strain.
    if (now - this.lastFrame > 1000) {
      this.since = now;
      this.counted = 0;
    }
    this.lastFrame = now;
    this.counted += 1;
    if (now - this.since >= 1000) {
      this.strain.second((now - this.since) / this.counted);
      this.counted = 0;
      this.since = now;
    }
    for (const painter of this.painters) painter();
    this.request = this.painters.size ? requestAnimationFrame(this.frame) : 0;
  };
}
