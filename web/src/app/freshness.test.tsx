import { act, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { LiveButton } from "../panels/scope/live-button";
import { useBench } from "../stream/bench-store";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { recordedAnswer, recordedBench } from "../testing/recorded";
import { mount } from "../testing/render";
import { Banner } from "./banner";
import { RunControls } from "./header/run-controls";
import { StateBadge } from "./header/state-badge";
import { Strip } from "./strip";

const recorded = await recordedBench("seven-steps");
const catalog = await recordedAnswer("catalog");
const bench = { ...recorded.bench, state: "running" as const, earliest_tick: 0 };

const STALE = /stale since \d/i;
const WHERE = ["Notice", "Steps of the scenario", "Timeline"];
const pass = (ms: number) => act(() => vi.advanceTimersByTimeAsync(ms));
const stale = () => WHERE.filter((name) => STALE.test(screen.queryByRole("region", { name })?.textContent ?? ""));

beforeEach(() => {
  vi.useFakeTimers();
  vi.spyOn(Math, "random").mockReturnValue(0.5);
  server.on("GET", "/catalog", catalog);
  server.on("GET", "/benches/:id", bench);
});
afterEach(() => vi.useRealTimers());

async function mountAll() {
  const board = connect(bench);
  mount(
    <>
      <StateBadge />
      <RunControls />
      <Banner />
      <LiveButton past={false} onLive={vi.fn()} />
      <Strip />
    </>,
  );
  await pass(0);
  await act(async () => board.say({ type: "events", events: recorded.events } as never));
  await pass(100);
  return board;
}

it("says in every bar and on every plot that the page is stale, and in none once the board is back", async () => {
  const board = await mountAll();
  const isFresh = () => {
    expect(stale()).toEqual([]);
    expect(screen.getByText("LIVE")).toBeVisible();
    expect(screen.getByTestId("bench-state")).toHaveTextContent("running");
    expect(screen.getByRole("button", { name: "Pause" })).toBeEnabled();
  };
  isFresh();
  await board.drop();
  await pass(300);
  isFresh(); // a blink
  await pass(1500);
  expect(stale()).toEqual(WHERE);
  expect(screen.queryByText("LIVE")).not.toBeInTheDocument();
  expect(screen.getByTitle(/^Drag or scroll/)).toHaveTextContent(STALE);
  expect(screen.getByTestId("bench-state")).toHaveTextContent("reconnecting");
  expect(screen.getByRole("button", { name: "Run" })).toBeDisabled();
  await act(async () => board.accept());
  await pass(250);
  expect(stale()).toEqual(WHERE); // an open channel is no news of the board
  board.hello(bench);
  isFresh();
});

it("is stale while an open connection is silent, and for good once it is closed", async () => {
  const board = await mountAll();
  await pass(1500);
  expect(stale()).toEqual(WHERE);
  board.status({});
  await pass(250);
  expect(stale()).toEqual([]);
  await board.drop(4403);
  expect(useBench.getState().connection.staleSince).toBeInstanceOf(Date);
  expect(stale()).toEqual(["Steps of the scenario", "Timeline"]);
});

it("does not take a page that is busy itself for a silent board", async () => {
  await mountAll();
  vi.spyOn(performance, "now").mockReturnValue(performance.now() + 5000);
  await pass(250);
  expect(stale()).toEqual([]);
});

const sources = import.meta.glob<string>(["../**/*.{ts,tsx}", "!../**/*.{test,d}.{ts,tsx}", "!../stream/*"], {
  query: "?raw",
  import: "default",
  eager: true,
});

it("has one source of freshness: no other part of the page looks at the connection to tell", () => {
  const looks = Object.keys(sources).filter((path) => /connection\.(phase|staleSince)/.test(sources[path]));
  // these cover reconnection, the offers of the page, and another open bench
  expect(looks.sort()).toEqual(["../bench/past.ts", "./app.tsx", "./banner.tsx", "./header/state-badge.tsx"]);
});
