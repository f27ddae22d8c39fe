// @vitest-environment jsdom
import { act } from "react";
import { createRoot } from "react-dom/client";
import { expect, it, vi } from "vitest";
import { useChanged } from "./use-changed";

it("draws again for what is another value, and for nothing else", () => {
  vi.stubGlobal("IS_REACT_ACT_ENVIRONMENT", true);
  let set: (next: { at: number }) => void = () => undefined;
  const drawn: number[] = [];
  const Shown = () => {
    const [value, setValue] = useChanged({ at: 0 });
    set = setValue;
    drawn.push(value.at);
    return null;
  };
  act(() => createRoot(document.createElement("div")).render(<Shown />));
  for (const at of [0, 1, 1, 2, 2, 0]) act(() => set({ at }));
  expect(drawn).toEqual([0, 1, 2, 0]);
});
