import uPlot from "uplot";
import { fontFor } from "../../ui/canvas-font";

/** Write each unit above its axis, and the unit of time at the foot of the first. */
export function drawUnits(u: uPlot, units: string[], time: string, fontSize: number, colour: string): void {
  const { ctx, bbox } = u;
  const ratio = uPlot.pxRatio;
  const above = bbox.top - (fontSize * 0.5 + 4) * ratio;
  const right = bbox.left + bbox.width;
  ctx.save();
  ctx.font = fontFor(fontSize, ratio, 600);
  ctx.fillStyle = colour;
  ctx.textBaseline = "alphabetic";
  units.forEach((unit, axis) => {
    ctx.textAlign = axis === 0 ? "right" : "left";
    const x = axis === 0 ? bbox.left - 6 * ratio : right + (6 + (axis - 1) * fontSize * 4) * ratio;
    ctx.fillText(unit, x, above);
  });
  ctx.textAlign = "right";
  ctx.fillText(time, bbox.left - fontSize * 2.2 * ratio, bbox.top + bbox.height + (fontSize + 5) * ratio);
  ctx.restore();
}
