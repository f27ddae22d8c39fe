import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import type { Bench, LogEntry } from "../api/types";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { logEntry } from "../testing/log-entry";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { mount } from "../testing/render";
import { Strip } from "./strip";

const recorded = await recordedBench("seven-steps");
const catalog = await recordedAnswer("catalog");
const library = import.meta.glob<string>("../../../scenarios/library/*.toml", {
  query: "?raw",
  import: "default",
  eager: true,
});

beforeEach(() => void server.on("GET", "/catalog", catalog));

async function show(bench: Partial<Bench>, events: LogEntry[]) {
  const board = connect({ ...recorded.bench, pending: [], tick: 900_000, ...bench });
  const { user } = mount(<Strip />);
  await board.events(events);
  const button = await screen.findByRole("button", { name: /^(All steps|Findings)$/ });
  await user.click(button);
  const list = await screen.findByRole("list", { name: /^(All steps|Findings at each step)$/ });
  const said = within(list).getAllByRole("listitem");
  return { name: button.textContent, said: said.map((one) => one.lastElementChild?.textContent) };
}

const injected = (fault: string, i: number) =>
  logEntry({ seq: i + 1, tick: 100 * (i + 1), kind: "inject", actor: "scenario", command: { fault, severity: 0.05 } });

/** Every scenario without a diagnoser, and the faults that it injects. */
const unwatched = Object.entries(library).flatMap(([path, text]) => {
  const faults = [...text.matchAll(/fault = "(\w+)"/g)].map(([, fault]) => fault);
  return /^\[diagnosers\b|^diagnosers\b/m.test(text) || faults.length === 0 ? [] : [{ path, faults }];
});

it("knows the scenarios without a diagnoser", () => {
  expect(Object.keys(library).length).toBeGreaterThan(100);
  expect(unwatched.map(({ path }) => path)).toContain("../../../scenarios/library/gyro-forced-drive.toml");
});

it.each(unwatched)("tells no finding where no diagnoser looks: $path", async ({ faults }) => {
  const { name, said } = await show({ diagnosers: {} }, faults.map(injected));
  expect(name).toBe("All steps");
  expect(new Set(said)).toEqual(new Set(["done"]));
});

it("tells no finding of a diagnoser that is not compared with the truth", async () => {
  const { said } = await show({}, [injected("added_mass", 0)]);
  expect(new Set(said)).toEqual(new Set(["done"]));
});

it("tells what was found after which delay, and what was said before", async () => {
  const truth = (seq: number, tick: number, name: string) =>
    logEntry({ seq, tick, kind: "truth_changed", text: `kalman: the truth is ${name}`, new: name });
  const found = (seq: number, tick: number, name: string, delay: number) =>
    logEntry({ seq, tick, kind: "recognised", text: `kalman found ${name}`, old: delay, new: name });
  const { name, said } = await show({ dt_ms: 0.02 }, [
    truth(1, 0, "healthy"),
    found(2, 40, "healthy", 0),
    injected("added_mass", 2),
    truth(4, 300, "m+5"),
    found(5, 340, "m+5", 37),
    injected("damping", 5),
  ]);
  expect(name).toBe("Findings");
  expect(said.map((one) => one?.replace(/\s/g, " "))).toEqual([
    "said healthy before",
    "found mass +5 % after 740 µs",
    "nothing to find",
  ]);
});

it("looks for no finding where the controller changes", async () => {
  const truth = logEntry({
    seq: 1,
    tick: 0,
    kind: "truth_changed",
    text: "kalman: the truth is healthy",
    new: "healthy",
  });
  const { said } = await show({}, [
    truth,
    logEntry({ seq: 2, tick: 100, kind: "switch", actor: "scenario", command: { switch: "pid" } as never }),
    injected("damping", 2),
  ]);
  expect(said).toEqual(["not found", "done", "nothing to find"].map((one) => expect.stringContaining(one)));
});
