// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { act } from "react";
import { createRoot } from "react-dom/client";
import { beforeEach, expect, it, vi } from "vitest";
import { useBench } from "../../stream/bench-store";
import { ConditionFields } from "./condition-fields";

beforeEach(() => {
  vi.stubGlobal("IS_REACT_ACT_ENVIRONMENT", true);
  window.matchMedia ??= () => ({ matches: false, addEventListener() {}, removeEventListener() {} }) as never;
  const signals = [
    { name: "plant.displacement", unit: "um", meaning: "true displacement" },
    { name: "control.voltage", unit: "V", meaning: "voltage" },
  ];
  useBench.setState({ bench: { signals } } as never);
});

function shown(signal: string, none?: string) {
  const page = document.createElement("div");
  const root = createRoot(page);
  act(() =>
    root.render(
      <MantineProvider env="test">
        <ConditionFields
          label="When"
          none={none}
          condition={{ signal, above: true, level: 2 }}
          onChange={() => undefined}
        />
      </MantineProvider>,
    ),
  );
  const found = {
    options: [...(page.querySelector("select")?.querySelectorAll("option") ?? [])].map((option) => option.textContent),
    level: page.querySelector("input")?.value,
  };
  act(() => root.unmount());
  return found;
}

it("offers the signals of the bench in words, and asks for the level in the unit of the signal", () => {
  expect(shown("control.voltage")).toEqual({ options: ["plant displacement", "control voltage"], level: "2 V" });
  expect(shown("plant.displacement").level).toBe("2 µm");
});

it("asks for no level where nothing is waited for", () => {
  expect(shown("", "at once")).toEqual({
    options: ["at once", "plant displacement", "control voltage"],
    level: undefined,
  });
});
