// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { act } from "react";
import { createRoot, type Root } from "react-dom/client";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { Slider } from "./slider";

let root: Root;

beforeEach(() => {
  vi.stubGlobal("IS_REACT_ACT_ENVIRONMENT", true);
  window.matchMedia ??= () => ({ matches: false, addEventListener() {}, removeEventListener() {} }) as never;
  root = createRoot(document.body.appendChild(document.createElement("div")));
});
afterEach(() => {
  act(() => root.unmount());
  document.body.replaceChildren();
  vi.unstubAllGlobals();
});

it("ends a tap shorter than a picture with the value that was tapped", async () => {
  const said: [string, number][] = [];
  await act(() =>
    root.render(
      <MantineProvider env="test">
        <Slider
          value={10}
          onChange={(value) => said.push(["moves to", value])}
          onChangeEnd={(value) => said.push(["ends at", value])}
        />
      </MantineProvider>,
    ),
  );
  const track = document.querySelector(".mantine-Slider-trackContainer") as HTMLElement;
  track.getBoundingClientRect = () => ({ left: 0, width: 100, height: 10 }) as DOMRect;
  // the pictures of a slow page: later than the end that waits for no picture
  const pictures: FrameRequestCallback[] = [];
  vi.stubGlobal("requestAnimationFrame", (picture: FrameRequestCallback) => pictures.push(picture));
  await act(async () => {
    track.dispatchEvent(new MouseEvent("mousedown", { clientX: 70, bubbles: true }));
    document.dispatchEvent(new MouseEvent("mouseup"));
    await new Promise((resolve) => setTimeout(resolve, 20));
    for (const picture of pictures) picture(0);
  });
  expect(said).toEqual([
    ["moves to", 70],
    ["ends at", 70],
  ]);
});
