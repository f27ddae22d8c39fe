/** Where the largest swing is drawn, as a share of the width, and the share below and above which the factor changes. */
const SHARE = { best: 0.04, least: 0.012, most: 0.06 };
const FORGET = 0.998;
const STEPS = [1, 2, 5];
const MOST = 10_000;

/** How much larger than life a motion is drawn: a round factor that changes rarely. */
export class Magnifier {
  private peak = 0;
  private factor = 1;

  /** The factor for a motion of this size on a picture of this width. */
  of(size: number, width: number): number {
    this.peak = Math.max(Math.abs(size), this.peak * FORGET);
    if (this.peak === 0) return this.factor;
    const drawn = (this.peak * this.factor) / width;
    if (drawn < SHARE.least || drawn > SHARE.most) this.factor = round((SHARE.best * width) / this.peak);
    return this.factor;
  }
}

/** The largest of 1, 2, 5, 10, ... that is not above a value. */
function round(value: number): number {
  const decade = 10 ** Math.floor(Math.log10(Math.min(Math.max(value, 1), MOST)));
  return decade * (STEPS.findLast((step) => step * decade <= value) ?? 1);
}
