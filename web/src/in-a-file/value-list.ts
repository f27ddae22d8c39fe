import { formatShort } from "../ui/format";
import { roundTo } from "../ui/unit-scale";
import { element, write } from "./dom";
import type { FileBench } from "./file-bench";
import type { FileValue } from "./file-document";

const STEPS = 200;

/** The values that may be set while the bench runs. */
export class ValueList {
  readonly root = element("section", { className: "panel list" }, element("h2", {}, "Values"));
  private readonly shows: (() => void)[] = [];

  constructor(bench: FileBench, act: (what: () => void) => void) {
    for (const [path, value] of Object.entries(bench.document.values))
      this.root.append(this.row(bench, path, value, act));
  }

  /** Show the values of now. */
  show(): void {
    for (const show of this.shows) show();
  }

  private row(bench: FileBench, path: string, value: FileValue, act: (what: () => void) => void): HTMLElement {
    const { grid } = value.dependence;
    const [low, high] = grid ? [0, grid.length - 1] : [value.low, value.high];
    const slider = element("input", { type: "range", min: `${low}`, max: `${high}`, step: grid ? "1" : "any" });
    slider.ariaLabel = path;
    const chosen = () => {
      const at = Number(slider.value);
      if (grid) return grid[at];
      const step = (high - low) / STEPS;
      return Math.min(high, Math.max(low, roundTo(low + Math.round((at - low) / step) * step, 6)));
    };
    const text = element("span", { className: "severity" });
    const show = () => write(text, formatShort(chosen(), value.unit));
    slider.oninput = show;
    slider.onchange = () => act(() => bench.apply({ set: { [path]: chosen() } }));
    this.shows.push(() => {
      if (document.activeElement === slider) return;
      const now = bench.values[path];
      slider.value = String(grid ? grid.indexOf(now) : now);
      write(text, formatShort(now, value.unit));
    });
    const name = element("span", { title: path }, value.label || path.replaceAll(/[._]/g, " "));
    return element("label", { className: "value" }, name, slider, text);
  }
}
