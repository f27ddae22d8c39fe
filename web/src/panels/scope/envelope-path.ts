import uPlot from "uplot";

export type Envelope = { low: Float32Array; high: Float32Array };

/**
 * uPlot path builder for min/max columns: a bar wherever a column spans more than a line is thick, and a line
 * through the middles. A spike of one tick is a bar of one pixel, so it can never be missed.
 */
export function envelopePath(envelope: (series: number) => Envelope | undefined): uPlot.Series.PathBuilder {
  return (u, index) => {
    const columns = envelope(index);
    const stroke = new Path2D();
    const fill = new Path2D();
    const paths = {
      stroke,
      fill,
      clip: undefined,
      band: undefined,
      gaps: undefined,
      flags: 1,
    } as unknown as uPlot.Series.Paths;
    const scale = u.scales[u.series[index].scale ?? "y"];
    const time = u.data[0];
    const { min: x0, max: x1 } = u.scales.x;
    if (!columns || x0 == null || x1 == null || scale.min == null || scale.max == null) return paths;
    const { left, top, width, height } = u.bbox;
    const perX = width / (x1 - x0);
    const perY = height / (scale.max - scale.min);
    const bottom = top + height + scale.min * perY;
    const bar = Math.max(1, Math.round(uPlot.pxRatio));
    let drawing = false;
    for (let c = 0; c < time.length; c += 1) {
      const low = columns.low[c];
      const high = columns.high[c];
      if (Number.isNaN(low)) continue;
      const x = left + (time[c] - x0) * perX;
      const yHigh = bottom - high * perY;
      const yLow = bottom - low * perY;
      if (yLow - yHigh > bar) fill.rect(Math.round(x - bar / 2), yHigh, bar, yLow - yHigh);
      const y = (yLow + yHigh) / 2;
      if (drawing) stroke.lineTo(x, y);
      else stroke.moveTo(x, y);
      drawing = true;
    }
    return paths;
  };
}
