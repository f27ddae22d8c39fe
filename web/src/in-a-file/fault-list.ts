import { severityScale, severityText } from "../bench/severity";
import { groupBy } from "../ui/group-by";
import { roundTo } from "../ui/unit-scale";
import { button, element, write } from "./dom";
import type { FileBench } from "./file-bench";
import type { FileFault } from "./file-document";

const STEPS = 100;

/** The faults of a bench: each with a slider of its severity, to inject and to heal. */
export class FaultList {
  readonly root = element("section", { className: "panel list" }, element("h2", {}, "Faults"));
  private readonly bench: FileBench;
  private readonly rows: { name: string; show(): void }[] = [];

  constructor(bench: FileBench, act: (what: () => void) => void) {
    this.bench = bench;
    for (const [group, faults] of groupBy(
      Object.entries(bench.document.faults),
      ([, { group }]) => group || "Others",
    )) {
      this.root.append(element("h3", {}, group));
      for (const [name, fault] of faults) this.root.append(this.row(name, fault, act));
    }
  }

  /** Show which faults act. */
  show(): void {
    for (const row of this.rows) row.show();
  }

  private row(name: string, fault: FileFault, act: (what: () => void) => void): HTMLElement {
    const { grid } = fault.variants[0].dependence;
    const scale = severityScale(
      { name: "severity", unit: fault.unit, minimum: fault.minimum, maximum: fault.maximum } as never,
      fault.suggested,
    );
    const ends = grid ? [0, grid.length - 1] : [fault.low, fault.high];
    const step = grid ? 1 : (ends[1] - ends[0]) / STEPS;
    const slider = element("input", { type: "range", min: `${ends[0]}`, max: `${ends[1]}`, step: grid ? "1" : "any" });
    slider.value = String(grid ? grid.indexOf(fault.suggested) : fault.suggested);
    slider.ariaLabel = `Severity: ${fault.title}`;
    const severity = () => {
      const value = Number(slider.value);
      if (grid) return grid[value];
      return value === fault.suggested ? value : roundTo(Math.round(value / step) * step, 6);
    };
    const inject = () => act(() => severity() !== 0 && this.bench.apply({ fault: name, severity: severity() }));
    const press = button("Inject", () =>
      this.bench.faults.has(name) ? act(() => this.bench.apply({ heal: [name] })) : inject(),
    );
    const text = element("span", { className: "severity" });
    const line = element("div", { className: "fault" }, element("span", { className: "name" }, fault.title));
    line.append(slider, text, press);
    const show = () => {
      const acting = this.bench.faults.get(name);
      line.dataset.active = String(acting !== undefined);
      write(text, severityText(acting?.severity ?? severity(), scale, fault.unit));
      write(press, acting ? "Heal" : "Inject");
      press.ariaLabel = `${acting ? "Heal" : "Inject"}: ${fault.title}`;
    };
    slider.oninput = show;
    slider.onchange = () => {
      if (this.bench.faults.has(name) && this.bench.faults.get(name)?.severity !== severity()) inject();
    };
    this.rows.push({ name, show });
    show();
    return line;
  }
}
