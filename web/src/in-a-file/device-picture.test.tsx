import { afterEach, beforeEach, expect, it } from "vitest";
import { recordedAnswer } from "../testing/recorded";
import { DevicePicture } from "./device-picture";
import type { FileBench } from "./file-bench";
import type { FileDocument } from "./file-document";

const { evaluation } = await recordedAnswer("design");
const drawn = { geometry: evaluation.geometry, is_stand_in: true };

/** A bench with these values of its signals. */
function benchOf(motion: Record<string, number>, plan: FileDocument["plan"] = drawn) {
  const names = Object.keys(motion);
  return {
    document: { plan, faults: { added_mass: { title: "Added mass", shows: "plate" } } },
    signals: names.map((name) => ({ name, unit: "um", meaning: "" })),
    faults: new Map<string, unknown>(),
    latest: (column: number) => motion[names[column]],
  };
}

const show = (bench: object) => {
  const picture = new DevicePicture(bench as FileBench);
  document.body.append(picture.root);
  return picture;
};
const moved = () => [...document.querySelectorAll("path")].flatMap((path) => path.getAttribute("transform") ?? []);
const red = () => document.querySelectorAll("[data-fault=true]").length;

const clear = () => document.body.replaceChildren();
beforeEach(clear);
afterEach(clear);

it("moves with the newest tick, a round number of times larger than life", () => {
  const motion = { "plant.displacement": 2 };
  const picture = show(benchOf(motion));
  picture.draw();
  const first = moved();
  expect(first.length).toBeGreaterThan(4);
  expect(document.body.textContent).toMatch(/motion ×\d+\./);
  motion["plant.displacement"] = -2;
  picture.draw();
  expect(moved()).not.toEqual(first);
});

it("marks the part that a fault is seen on, and names the fault", () => {
  const bench = benchOf({ "plant.displacement": 0 });
  const picture = show(bench);
  picture.show();
  expect(red()).toBe(0);
  bench.faults.set("added_mass", { severity: 0.05 });
  picture.show();
  expect(red()).toBe(1);
  expect(document.querySelector("svg")?.getAttribute("aria-label")).toBe("The device from above, with Added mass");
});

it("says that another device is drawn, where the device has no drawing", () => {
  show(benchOf({ "plant.displacement": 0 }));
  expect(document.body.textContent).toContain("LCR-350 is shown");
});

it("draws a gyroscope as frames and plate, each along its axes; any fault is on the plate", () => {
  const bench = benchOf({ "plant.x": 4, "plant.y": 1 }, { geometry: null, is_stand_in: false });
  const picture = show(bench);
  picture.draw();
  const [drive, sense, plate] = moved().map((text) => text.match(/-?[\d.]+/g)?.map(Number));
  expect([drive?.[1], sense?.[0]]).toEqual([0, 0]);
  expect(plate).toEqual([drive?.[0], sense?.[1]]);
  bench.faults.set("added_mass", { severity: 0.05 });
  picture.show();
  expect(red()).toBe(1);
});
