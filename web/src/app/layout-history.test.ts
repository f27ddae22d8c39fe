// @vitest-environment jsdom
import type { DockviewApi, SerializedDockview } from "dockview-react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { LayoutHistory } from "./layout-history";

beforeEach(() => {
  vi.useFakeTimers();
});
afterEach(() => {
  vi.useRealTimers();
});

/** A dock with its stored form alone. */
function dock() {
  let listener: () => void = () => {};
  let stored = { grid: { width: 100, height: 50, root: { size: 10 } }, panels: {}, activeGroup: "1" };
  const api = {
    toJSON: () => structuredClone(stored) as unknown as SerializedDockview,
    onDidLayoutChange: (listen: () => void) => {
      listener = listen;
    },
  } as unknown as DockviewApi;
  const put = (next: object) => {
    stored = { ...stored, ...next };
    listener();
  };
  return { api, put, now: () => stored };
}

const settle = () => vi.advanceTimersByTime(1000);

function watched() {
  const { api, put, now } = dock();
  const history = new LayoutHistory();
  history.watch(api);
  settle();
  const go = (way: "undo" | "redo") => {
    history.go(way, (_, layout) => put(layout));
    settle();
  };
  const change = (next: object) => {
    put(next);
    settle();
  };
  return { history, change, put, go, now };
}

it("goes back and forward through what was changed", () => {
  const { history, change, go, now } = watched();
  change({ panels: { a: {} } });
  change({ panels: { a: {}, b: {} } });
  go("undo");
  expect(now().panels).toEqual({ a: {} });
  go("undo");
  expect(now().panels).toEqual({});
  expect(history.lastAt("undo")).toBeUndefined();
  go("redo");
  go("redo");
  expect(now().panels).toEqual({ a: {}, b: {} });
});

it("counts neither a look at another tab nor another size of the page", () => {
  const { history, change } = watched();
  change({ activeGroup: "2" });
  change({ grid: { width: 80, height: 50, root: { size: 8 } } });
  expect(history.lastAt("undo")).toBeUndefined();
  change({ grid: { width: 80, height: 50, root: { size: 20 } } });
  expect(history.lastAt("undo")).toBeDefined();
});

it("takes a pull at an edge as one change, and forgets what was undone once there is another", () => {
  const { history, change, put, go, now } = watched();
  for (const size of [11, 12, 13]) put({ grid: { width: 100, height: 50, root: { size } } });
  settle();
  go("undo");
  expect(now().grid.root.size).toBe(10);
  change({ panels: { c: {} } });
  expect(history.lastAt("redo")).toBeUndefined();
});
