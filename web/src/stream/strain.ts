const SLOW_MS = 22;
const SLOW_SECONDS = 2;
const REST_SECONDS = 30;

/**
 * Whether this machine keeps up with full drawing, judged once a second by the mean time between frames.
 *
 * Two slow seconds call for simpler drawing; after half a minute the full one is tried again.
 */
export class Strain {
  strained = false;
  private slow = 0;
  private rest = 0;

  second(meanFrameMs: number): void {
    if (this.strained) {
      this.rest -= 1;
      if (this.rest <= 0) this.strained = false;
      return;
    }
    this.slow = meanFrameMs > SLOW_MS ? this.slow + 1 : 0;
    if (this.slow < SLOW_SECONDS) return;
    this.strained = true;
    this.slow = 0;
    this.rest = REST_SECONDS;
  }
}
