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

it.each(["lecture", "lab", "research"] as const)("holds the whole first look in the scope of the rate: %s", (name) => {
  const dock = createDockview(document.createElement("div"), {
    createComponent: () => ({ element: document.createElement("div"), init: () => undefined }),
  });
  dock.layout(1366, 600);
  BUILT_IN_AXES[name](dock, 1366, 600);
  const { scope } = dock.getPanel("rate")?.params as { scope: ScopeConfig };
  expect(scope.windowMs).toBeGreaterThanOrEqual(Number(/^duration_ms = (.+)$/m.exec(FIRST_LOOK)?.[1]));
  dock.dispose();
});
