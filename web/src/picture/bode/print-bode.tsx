import { CANVAS, onWhite } from "../../ui/palette";
import { drawnSvg } from "../drawn-svg";
import type { LegendEntry } from "../legend";
import type { Picture } from "../picture";
import { fileStem } from "../picture-name";
import { BodeField, type BodeFieldProps } from "./bode-field";

/** A Bode diagram as a picture. */
export function printBode(
  title: string,
  { curves, band, points, degrees }: Pick<BodeFieldProps, "curves" | "band" | "points" | "degrees">,
): Picture {
  const ofPaper = {
    curves: curves.map((curve) => ({ ...curve, colour: onWhite(curve.colour) })),
    points: points && { ...points, colour: onWhite(points.colour) },
  };
  const legend: LegendEntry[] = ofPaper.curves.map(({ name, colour, dash }) => ({
    name,
    colour,
    dashes: dash?.split(" ").map(Number),
  }));
  if (ofPaper.points) legend.push({ name: ofPaper.points.name, colour: ofPaper.points.colour, mark: "dot" });
  if (band) legend.push({ name: band.name, colour: `${CANVAS.light.accent}42`, mark: "field" });
  return {
    title,
    stem: fileStem(title),
    across: "frequency, Hz",
    legend,
    height: 460,
    paint: (pen, box) =>
      pen.add(drawnSvg(<BodeField label={title} {...ofPaper} band={band} degrees={degrees} {...box} isFramed />)),
  };
}
