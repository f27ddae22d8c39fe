// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { act } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, expect, it, test, vi } from "vitest";
import { Knob, positionOf, valueAt } from "./knob";

let root: Root;
const change = vi.fn();

const show = (value: number) =>
  act(() =>
    root.render(
      <MantineProvider env="test">
        <Knob label="Gap" unit="um" low={0} high={10} step={0.1} value={value} original={2} onChange={change} />
      </MantineProvider>,
    ),
  );
const box = () => document.querySelector("input") as HTMLInputElement;
const press = (at: Element, key: string) =>
  act(() => at.dispatchEvent(new KeyboardEvent("keydown", { key, code: key, bubbles: true })));

beforeEach(() => {
  vi.stubGlobal("IS_REACT_ACT_ENVIRONMENT", true);
  vi.stubGlobal(
    "ResizeObserver",
    class {
      observe() {}
      unobserve() {}
      disconnect() {}
    },
  );
  window.matchMedia ??= () => ({ matches: false, addEventListener() {}, removeEventListener() {} }) as never;
  change.mockClear();
  root = createRoot(document.body.appendChild(document.createElement("div")));
});
afterEach(() => {
  act(() => root.unmount());
  document.body.replaceChildren();
  vi.unstubAllGlobals();
});

test("the box shows the number of the slider, without the error of its floating point", () => {
  show(0.1 + 0.2);
  expect(box().value).toBe("0.3");
  show(7.000000000000001);
  expect(box().value).toBe("7");
});

test("stepping the box gives round numbers", () => {
  let value = 6.9;
  for (let i = 0; i < 5; i += 1) {
    show(value);
    press(box(), "ArrowUp");
    value = change.mock.lastCall?.[0];
  }
  expect(change.mock.calls.map(([given]) => given)).toEqual([7, 7.1, 7.2, 7.3, 7.4]);
});

test("the way back names the number it goes to, with its unit", () => {
  show(3);
  const back = document.querySelector("button") as HTMLButtonElement;
  expect(back.getAttribute("aria-label")).toBe("Gap: back to 2\u00a0µm");
  act(() => back.click());
  expect(change).toHaveBeenCalledWith(2);
});

it("goes there and back, linear and by ratios", () => {
  const linear = { low: 100, high: 800, log: false };
  expect(valueAt(positionOf(350, linear), linear, 1)).toBe(350);
  const log = { low: 0.1, high: 1e6, log: true };
  expect(positionOf(Math.sqrt(0.1 * 1e6), log)).toBeCloseTo(0.5);
  expect(valueAt(positionOf(101_000, log), log, 0)).toBe(101_000);
});

it("stays at its ends for what lies beyond", () => {
  expect(positionOf(900, { low: 100, high: 800, log: false })).toBe(1);
  expect(positionOf(-3, { low: 0.1, high: 10, log: true })).toBe(0);
});
