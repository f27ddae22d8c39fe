import type { GalleryCard } from "../api/types";
import { formatFigure } from "../ui/format";
import { metricScale } from "../ui/metric-name";

interface Headline {
  metric: string;
  figure: string;
  ours: string;
  printed: string;
}

const MOST = 2;

/** Our figures over the printed numbers. */
export function headlines(card: GalleryCard): Headline[] {
  return card.expectations
    .filter((entry) => typeof entry.published_value === "number" && typeof entry.measured === "number")
    .slice(0, MOST)
    .map(({ metric, measured, published_value }) => {
      const { name, unit, shown } = metricScale(metric, [measured, published_value]);
      const [ours, printed] = [measured, published_value].map((value) => {
        const figure = formatFigure(metric, value && shown(value));
        return unit ? `${figure}\u00a0${unit}` : figure;
      });
      return { metric, figure: name, ours, printed };
    });
}
