import type { GalleryCard } from "../api/types";
import { formatFigure } from "../ui/format";
import { metricTitle, metricUnit, micro } from "../ui/metric-name";

export interface Headline {
  metric: string;
  figure: string;
  ours: string;
  printed: string;
}

const MOST = 2;
/** A longer text says more than a number. */
const LONGEST = 40;
/** Numbers that name something: figures, sections, steps, equations. */
const NAMES = /figure|table|step|order|=|,|;|\d\.\d+\.\d/i;

/** Whether what is printed is a number to hold ours against: "approximately 12 %", not "figure 1.3.4". */
export function isNumber(published: string): boolean {
  const text = published.replaceAll(/\([^)]*\)/g, "").trim();
  return text.length <= LONGEST && !NAMES.test(text) && /(?:^|\s)[-−]?\d/.test(text);
}

/** Our figures over the printed ones, where those are numbers. */
export function headlines(card: GalleryCard): Headline[] {
  return card.expectations
    .filter((entry) => isNumber(entry.published) && entry.measured !== null && entry.measured !== undefined)
    .slice(0, MOST)
    .map((entry) => {
      const unit = metricUnit(entry.metric);
      const figure = formatFigure(entry.metric, entry.measured);
      return {
        metric: entry.metric,
        figure: metricTitle(entry.metric).replace(/, [^,]*$/, ""),
        ours: unit ? `${figure}\u00a0${unit}` : figure,
        printed: micro(entry.published).replaceAll(" %", "\u00a0%"),
      };
    });
}
