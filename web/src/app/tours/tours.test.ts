// @vitest-environment jsdom
import { afterEach, expect, it, vi } from "vitest";
import { api } from "../../api/api";
import { ApiError } from "../../api/client";
import { forgetRun, TOURS } from "./tours";

// panels hold plots, which ask for the screen as soon as they are loaded
vi.hoisted(() => {
  window.matchMedia ??= () => ({ matches: false, addEventListener() {}, removeEventListener() {} }) as never;
});

const said: string[] = [];
/** States that the server tells of the run after it refused to cancel it; then it is done. */
const ends: string[] = [];

/** A server on which the run of the tour is in a state when the tour ends. */
async function takeTour(
  state: "running" | "done",
  others: string[] = [],
  answer: () => object = () => ({}),
): Promise<void> {
  vi.spyOn(api, "runs").mockResolvedValue(others.map((id) => ({ id })) as never);
  vi.spyOn(api, "startRun").mockResolvedValue({ id: "of-tour" } as never);
  vi.spyOn(api, "cancelRun").mockImplementation((id) => {
    said.push(`cancel ${id}`);
    const refusal = { code: "conflict", message: "it has ended", field: null, details: {} };
    return state === "running"
      ? Promise.resolve(answer() as never)
      : Promise.reject(new ApiError(409, refusal as never));
  });
  vi.spyOn(api, "run").mockImplementation(() => Promise.resolve({ state: ends.shift() ?? "done" } as never));
  vi.spyOn(api, "removeRuns").mockImplementation((ids) => {
    said.push(`remove ${ids}`);
    return Promise.resolve({} as never);
  });
  await TOURS.flatMap(({ steps }) => steps)
    .find(({ title }) => title === "A run of its own")
    ?.does?.();
  await forgetRun();
}

afterEach(() => {
  said.length = 0;
  vi.restoreAllMocks();
});

it.each(["running", "done"] as const)("the run of a tour goes with it while it is %s, and only once", async (state) => {
  await takeTour(state);
  await forgetRun();
  expect(said).toEqual(["cancel of-tour", "remove of-tour"]);
});

it("a run that was there before the tour stays", async () => {
  await takeTour("done", ["of-tour"]);
  expect(said).toEqual([]);
});

it("a run that takes long to end is cancelled until it has ended, and only then removed", async () => {
  const states = ["running", "running", "cancelled"];
  await takeTour("running", [], () => ({ state: states.shift() }));
  expect(said).toEqual(["cancel of-tour", "cancel of-tour", "cancel of-tour", "remove of-tour"]);
});

it("a run that has ended and is not counted as ended yet is removed once it is", async () => {
  ends.push("running", "running");
  await takeTour("done");
  expect(said).toEqual(["cancel of-tour", "cancel of-tour", "cancel of-tour", "remove of-tour"]);
});

it("a run that the server is still being asked for when the tour is left goes with it", async () => {
  let answer = (_: object) => {};
  vi.spyOn(api, "runs").mockResolvedValue([]);
  vi.spyOn(api, "startRun").mockReturnValue(new Promise((resolve) => (answer = resolve as never)));
  vi.spyOn(api, "cancelRun").mockResolvedValue({ state: "cancelled" } as never);
  const removed = vi.spyOn(api, "removeRuns").mockResolvedValue({} as never);
  const steps = TOURS.flatMap(({ steps }) => steps);
  void steps.find(({ title }) => title === "A run of its own")?.does?.();
  const left = forgetRun();
  await vi.waitFor(() => expect(api.startRun).toHaveBeenCalled());
  answer({ id: "of-tour" });
  await left;
  expect(removed).toHaveBeenCalledWith(["of-tour"]);
});
