import { Magnifier } from "../panels/view3d/magnifier";
import { deviceDrawing } from "../picture/device-drawing";
import styles from "../picture/device-plan.module.css";
import {
  boxAround,
  GYROSCOPE_BOX,
  GYROSCOPE_PARTS,
  isFaulted,
  type PlanPart,
  resonatorParts,
} from "../picture/plan-parts";
import { formatNumber } from "../ui/format";
import { element, write } from "./dom";
import type { FileBench } from "./file-bench";

const SVG = "http://www.w3.org/2000/svg";
const STAND_IN = "This device has no drawing; LCR-350 is shown.";

/** The device from above: it moves with the newest tick, and the part with a fault is red. */
export class DevicePicture {
  readonly root = element("figure", { className: "panel device" });
  private readonly bench: FileBench;
  private readonly parts: readonly PlanPart[];
  private readonly paths: SVGPathElement[];
  private readonly picture = document.createElementNS(SVG, "svg");
  private readonly said = element("b");
  private readonly times = element("span");
  private readonly magnifier = new Magnifier();
  private readonly width: number;
  /** The columns of the motion: along x, and along y of a device that has both. */
  private readonly columns: number[];

  constructor(bench: FileBench) {
    this.bench = bench;
    const { geometry, is_stand_in: isStandIn } = bench.document.plan;
    const drawing = geometry && deviceDrawing(geometry);
    this.parts = drawing ? resonatorParts(drawing) : GYROSCOPE_PARTS;
    const box = drawing ? boxAround(drawing) : GYROSCOPE_BOX;
    this.width = drawing ? drawing.width : box[2];
    const names = bench.signals.map(({ name }) => name);
    const motion = drawing ? ["plant.displacement"] : ["plant.x", "plant.y"];
    this.columns = motion.map((name) => names.indexOf(name));
    this.paths = this.parts.map(({ path, look }) => {
      const made = document.createElementNS(SVG, "path");
      made.setAttribute("d", path);
      made.setAttribute("class", styles[look]);
      return made;
    });
    this.picture.setAttribute("viewBox", box.join(" "));
    this.picture.setAttribute("role", "img");
    this.picture.append(...this.paths);
    const words = element("figcaption", { className: "note" }, this.said, "From above", this.times, ".");
    if (isStandIn) words.append(` ${STAND_IN}`);
    this.root.append(this.picture, words);
  }

  /** Show which parts have a fault. */
  show(): void {
    const { faults, document } = this.bench;
    const acting = [...faults.keys()].flatMap((name) => document.faults[name] ?? []);
    const isFlat = document.plan.geometry !== null;
    const faulted = new Set(acting.flatMap(({ shows }) => (isFlat ? (shows ?? []) : "plate")));
    for (const [i, part] of this.parts.entries()) this.paths[i].dataset.fault = String(isFaulted(part, faulted));
    const said = acting.map(({ title }) => title).join(", ");
    write(this.said, said && `${said}. `);
    this.picture.setAttribute("aria-label", `The device from above${said && `, with ${said}`}`);
  }

  /** Move the parts to where they are after the newest tick. */
  draw(): void {
    const [x, y = 0] = this.columns.map((column) => this.bench.latest(column));
    if (!Number.isFinite(x) || !Number.isFinite(y)) return;
    const factor = this.magnifier.of(Math.hypot(x, y), this.width);
    write(this.times, `, motion ×${formatNumber(factor, 0)}`);
    for (const [i, { follow }] of this.parts.entries())
      if (follow) this.paths[i].setAttribute("transform", follow(factor * x, -factor * y));
  }
}
