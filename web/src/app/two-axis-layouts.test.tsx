import { createDockview } from "dockview-react";
import { expect, it } from "vitest";
import type { ScopeConfig } from "../stream/scope-config";
import { BUILT_IN_AXES } from "./two-axis-layouts";

const [FIRST_LOOK] = Object.values(
  import.meta.glob<string>("../../../scenarios/library/gyro-first-look.toml", {
    query: "?raw",
    import: "default",
    eager: true,
  }),
);

it.each([
  "lecture",
  "lab",
  "research",
] as const)("holds every step of the first look in the scope of the rate, at its end: %s", (name) => {
  const dock = createDockview(document.createElement("div"), {
    createComponent: () => ({ element: document.createElement("div"), init: () => undefined }),
  });
  dock.layout(1366, 600);
  BUILT_IN_AXES[name](dock, 1366, 600);
  const { scope } = dock.getPanel("rate")?.params as { scope: ScopeConfig };
  const [end, step] = ["duration_ms", "at_ms"].map((name) =>
    Number(new RegExp(`^${name} = (.+)$`, "m").exec(FIRST_LOOK)?.[1]),
  );
  expect(step).toBeGreaterThan(0);
  expect(scope.windowMs).toBeGreaterThan(end - step);
  dock.dispose();
});
