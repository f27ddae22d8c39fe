// @vitest-environment jsdom
import { act } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, expect, it, test, vi } from "vitest";
import { NumberField, nudge, parseNumber } from "./number-field";

let root: Root;
const commit = vi.fn();

const show = (value: number) =>
  act(() =>
    root.render(<NumberField label="Noise" unit="V" value={value} minimum={0} maximum={null} onCommit={commit} />),
  );
const field = () => document.querySelector("input") as HTMLInputElement;
const type = (text: string) =>
  act(() => {
    field().focus();
    Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value")?.set?.call(field(), text);
    field().dispatchEvent(new Event("input", { bubbles: true }));
  });
const press = (key: string) => act(() => field().dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true })));
const leave = () => act(() => field().blur());

beforeEach(() => {
  vi.stubGlobal("IS_REACT_ACT_ENVIRONMENT", true);
  commit.mockClear();
  root = createRoot(document.body.appendChild(document.createElement("div")));
  show(1);
});
afterEach(() => {
  act(() => root.unmount());
  document.body.replaceChildren();
  vi.unstubAllGlobals();
});

test("a value that comes while one types does not replace what is typed", () => {
  type("2");
  press("Enter");
  type("3");
  show(2);
  expect(field().value).toBe("3");
  press("Enter");
  expect(commit.mock.calls).toEqual([[2], [3]]);
});

test("a wrong entry and what is wrong with it stay when a value comes late, and go with one that comes after leaving", () => {
  type("-1");
  press("Enter");
  show(2);
  expect(field().value).toBe("-1");
  expect(document.querySelector("[role=alert]")?.textContent).toContain("at least 0");
  leave();
  show(3);
  expect(field().value).toBe("3");
  expect(document.querySelector("[role=alert]")).toBeNull();
  expect(commit).not.toHaveBeenCalled();
});

test("an entry taken on Enter is not taken again on leaving before its value has come", () => {
  type("2");
  press("Enter");
  leave();
  expect(commit.mock.calls).toEqual([[2]]);
  show(2);
  type("4");
  leave();
  expect(commit.mock.calls).toEqual([[2], [4]]);
});

test("Escape brings back the value of now", () => {
  type("7");
  show(2);
  press("Escape");
  expect(field().value).toBe("2");
  leave();
  expect(commit).not.toHaveBeenCalled();
});

const free = { minimum: null, maximum: null, integer: false };

it("reads any notation people type", () => {
  expect(["0.05", "0,05", "5e-2", " .05 ", "−1"].map((t) => parseNumber(t, free))).toEqual([
    0.05, 0.05, 0.05, 0.05, -1,
  ]);
});

it("says what is wrong", () => {
  expect(parseNumber("", free)).toBe("not a number");
  expect(parseNumber("abc", free)).toBe("not a number");
  expect(parseNumber("-1", { ...free, minimum: 0 })).toBe("at least 0");
  expect(parseNumber("11", { ...free, maximum: 10 })).toBe("at most 10");
  expect(parseNumber("1.5", { ...free, integer: true })).toBe("whole numbers only");
});

it("nudges by a unit of the second digit", () => {
  expect(nudge(3, 1, false)).toBe(3.1);
  expect(nudge(0.05, -1, false)).toBe(0.049);
  expect(nudge(7, 1, true)).toBe(8);
});
