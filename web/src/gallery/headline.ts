import type { GalleryCard } from "../api/types";
import { formatFigure } from "../ui/format";
import { metricTitle, metricUnit } from "../ui/metric-name";

export interface Headline {
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
    .map((entry) => {
      const unit = metricUnit(entry.metric);
      const [ours, printed] = [entry.measured, entry.published_value].map((value) => {
        const figure = formatFigure(entry.metric, value);
        return unit ? `${figure}\u00a0${unit}` : figure;
      });
      return { metric: entry.metric, figure: metricTitle(entry.metric).replace(/, [^,]*$/, ""), ours, printed };
    });
}
