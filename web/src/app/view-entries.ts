import type { PanelName, ViewName } from "../bench/panel-views";
import { type Benchlike, PANELS, panelsOn, VIEW, viewsOn } from "./panels";

/** A view of a panel in a list; the first view stands for its panel. */
interface ViewEntry {
  panel: PanelName;
  view: ViewName;
  isFirst: boolean;
  title: string;
  /** A line of words. */
  about: string;
}

/** Every view that suits a bench, in the order of the panels. */
export const viewEntries = (bench: Benchlike): ViewEntry[] =>
  panelsOn(bench).flatMap((panel) =>
    viewsOn(panel, bench).map((view, index): ViewEntry => {
      const { title, about } = PANELS[panel];
      const own = index === 0 ? { title, about } : { title: VIEW[view].title, about: `A view of ${title}` };
      return { panel, view, isFirst: index === 0, ...own };
    }),
  );
