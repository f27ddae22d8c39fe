import { element, menu } from "./dom";
import type { FileBench } from "./file-bench";

/** The controllers of each slot; a menu chooses the controller that drives. */
export class ControllerChoice {
  readonly root = element("section", { className: "panel list" });
  private readonly shows: (() => void)[] = [];

  constructor(bench: FileBench, act: (what: () => void) => void) {
    const { slots, writes } = bench.document.wirings;
    const names = Object.values(bench.driving);
    for (const [i, slot] of Object.keys(bench.driving).entries()) {
      const mates = Object.keys(slots).filter((name) => slots[name] === slot);
      const isThere = (name: string) => names.with(i, name).join("+") in writes.w.numbers;
      const choices = mates.filter(isThere).map((name) => [name, bench.document.controllers[name]] as const);
      const choice = menu("Controller", choices, bench.driving[slot], (name) =>
        act(() => bench.apply({ switch: name })),
      );
      const word = Object.keys(bench.driving).length > 1 ? `Drives: ${slot}` : "Drives";
      this.root.append(element("label", { className: "value" }, element("span", {}, word), choice));
      this.shows.push(() => {
        choice.value = bench.driving[slot];
      });
    }
  }

  /** Show which controllers drive now. */
  show(): void {
    for (const show of this.shows) show();
  }
}
