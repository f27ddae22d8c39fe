import { afterEach, expect, test, vi } from "vitest";
import { DrawLoop } from "./draw-loop";

afterEach(() => vi.unstubAllGlobals());

test("a painter that fails is told of and let go, and the others go on", () => {
  const frames: FrameRequestCallback[] = [];
  const errors: unknown[] = [];
  vi.stubGlobal("requestAnimationFrame", (frame: FrameRequestCallback) => frames.push(frame));
  vi.stubGlobal("reportError", (error: unknown) => errors.push(error));
  const loop = new DrawLoop();
  const painted: string[] = [];
  const broken = new Error("no canvas");
  loop.add(() => {
    painted.push("broken");
    throw broken;
  });
  const stop = loop.add(() => painted.push("whole"));
  for (let i = 0; i < 3; i++) frames.shift()?.(0);
  expect(painted).toEqual(["broken", "whole", "whole", "whole"]);
  expect(errors).toEqual([broken]);
  stop();
  frames.shift()?.(0);
  expect(frames).toEqual([]);
});
