// @vitest-environment jsdom
import { afterEach, expect, test, vi } from "vitest";
import { may, useMe } from "../api/me";
import type { Me } from "../api/types";
import type { PageName } from "../bench/places";
import { keymap } from "./keymap";
import { isOffered, PAGES } from "./pages";

// the pages hold plots, which ask for the screen as soon as they are loaded
vi.hoisted(() => {
  window.matchMedia ??= () => ({ matches: false, addEventListener() {}, removeEventListener() {} }) as never;
});

const be = (role: Me["role"]) =>
  useMe.setState({ me: { id: role, role, name: role, bench: null, class_id: null, hand: false } });
const pages = (role: Me["role"]) => Object.keys(PAGES).filter((page) => isOffered(page as PageName, role));
const keys = () => keymap().map(({ shown }) => shown);

afterEach(() => useMe.setState({ me: undefined }));

test("each role is offered the pages and keys of what it may do", () => {
  be("teacher");
  expect(pages("teacher")).toEqual(["bench", "class", "gallery", "runs", "benchmark", "designer", "theory"]);
  expect(keys()).toEqual(expect.arrayContaining(["Space", "F", "Shift S", "K", "M", "U", "N", "1"]));

  be("student");
  expect(pages("student")).toEqual(["bench", "gallery", "runs", "benchmark", "designer", "theory"]);
  expect(keys()).toEqual(expect.arrayContaining(["Space", "H", "N", "V", "U", "1"]));
  for (const key of ["F", "Shift S", "K", "M"]) expect(keys()).not.toContain(key);

  be("watcher");
  expect(pages("watcher")).toEqual(pages("student"));
  for (const key of ["Space", "H", "N", "V", "F", "Ctrl Z"]) expect(keys()).not.toContain(key);
  expect(keys()).toEqual(expect.arrayContaining(["1", "L", "D", "S"]));
});

test("nobody may anything before it is known who it is", () => {
  expect(may("drive")).toBe(false);
  expect(may("teach")).toBe(false);
});

test("each key does one thing", () => {
  be("teacher");
  const bound = keymap().map(({ key, shown }) => `${key} (${shown})`);
  expect(bound).toEqual([...new Set(bound)]);
  expect(keys()).toEqual([...new Set(keys())]);
});
