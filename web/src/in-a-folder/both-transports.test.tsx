import { screen } from "@testing-library/react";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { setAnswering } from "../api/client";
import { EventsPanel } from "../panels/events/events-panel";
import { FaultsPanel } from "../panels/faults/faults-panel";
import { DiagnoserLanes } from "../panels/lanes/diagnoser-lanes";
import { useLaneTime } from "../panels/lanes/use-lane-time";
import { useBench } from "../stream/bench-store";
import { decodeFrame } from "../stream/decode-frame";
import type { PanelFrame } from "../stream/panel-frame";
import { stream } from "../stream/stream";
import { server } from "../testing/fake-server";
import { connect } from "../testing/fake-transport";
import { FolderBoard } from "../testing/folder-board";
import { drawOnce } from "../testing/jsdom-gaps";
import { recordedAnswer, recordedBench, recordedFolder } from "../testing/recorded";
import { mount, words } from "../testing/render";
import { FolderServer } from "./folder-server";

const recorded = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const MASS = { fault: "added_mass", severity: 0.05 };
const SHOWN = { mode: "roll" as const, signals: recorded.frames.scope.signals, window_ms: 4, width: 200 };

/** The first look at tick 2000, with added mass from tick 1800 on, over either transport. */
interface Board {
  /** Let the page subscribe, and send the picture. */
  picture(): Promise<void>;
}

const BOARDS: [string, () => Promise<Board>][] = [
  [
    "the server, as recorded",
    async () => {
      const board = connect(recorded.bench);
      board.status({ scores: recorded.status.scores });
      await board.events(recorded.events);
      return { picture: async () => board.replay(recorded.frames.scope) };
    },
  ],
  [
    "the worker of a folder",
    async () => {
      const board = await FolderBoard.connect();
      for (const command of [{ kind: "step", ticks: 1800 }, MASS, { kind: "step", ticks: 200 }] as const)
        await board.command(command);
      return { picture: () => board.turn() };
    },
  ],
];

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("GET", "/classes", { classes: [] });
});
afterEach(() => setAnswering((request) => fetch(request)));

function Lanes() {
  const names = useBench((s) => s.bench?.diagnosers.kalman.names) ?? [];
  const time = useLaneTime(10, 0.01, undefined);
  return <DiagnoserLanes id="kalman" names={names} withTruth time={time} onWindow={() => undefined} />;
}

describe.each(BOARDS)("over %s", (_, open) => {
  it("has the tick, the state, the acting fault and the score", async () => {
    await open();
    const { bench, scores } = useBench.getState();
    expect(bench).toMatchObject({ tick: 2000, state: "paused", controller: "open_loop", dt_ms: 0.01 });
    expect(bench?.faults).toEqual(recorded.bench.faults);
    expect(bench?.signals).toEqual(recorded.bench.signals);
    expect(scores).toEqual(recorded.status.scores);
  });

  it("draws the same picture, number by number", async () => {
    const board = await open();
    const draw = vi.fn<(frame: PanelFrame) => void>();
    stream.client.feeds.open(SHOWN, draw);
    await board.picture();
    stream.client.feeds.draw();
    const bytes = Uint8Array.from(atob(recorded.frames.scope.bytes), (letter) => letter.charCodeAt(0));
    const [expected] = decodeFrame(bytes.buffer).panels;
    const [[found]] = draw.mock.calls;
    expect([found.startTick, found.endTick, found.columns]).toEqual([
      expected.startTick,
      expected.endTick,
      expected.columns,
    ]);
    for (const part of ["data", "latest"] as const) {
      expect(found[part]).toHaveLength(expected[part].length);
      found[part].forEach((value, i) => {
        expect(value).toBeCloseTo(expected[part][i], 6);
      });
    }
  });

  it("lists what happened, newest first", async () => {
    await open();
    mount(<EventsPanel />);
    const texts = (await screen.findAllByTitle(/^Tick/)).map(
      (one) => one.querySelector("span:nth-child(3)")?.textContent,
    );
    const told = recorded.events.filter(({ kind }) => !["opened", "step"].includes(kind)).map(({ text }) => text);
    expect(texts.filter((text) => told.includes(text ?? ""))).toEqual(told.reverse());
  });

  it("shows the verdict of the bank, its delay and its share", async () => {
    await open();
    mount(<Lanes />);
    await drawOnce();
    expect((await screen.findAllByText(words("mass +5 %")))[0]).toBeVisible();
    expect(screen.getByText(/^30\ssamples/)).toBeVisible();
    expect(screen.getByText(words("97.8 %"))).toBeVisible();
  });

  it("lists the acting fault with its severity and since when", async () => {
    await open();
    mount(<FaultsPanel />);
    expect(await screen.findByText(/^1\sactive fault$/)).toBeVisible();
    expect(screen.getByText("Added mass").closest("li")).toHaveTextContent(/\+5\s% since 18\.000\sms/);
  });
});

it("gives a page that has stopped no more than a few statuses, and then the newest", async () => {
  const { code, document, answers } = await recordedFolder();
  const told: { type: string; tick: number }[] = [];
  const folder = new FolderServer(code, document, answers, (message) => {
    if ("data" in message && typeof message.data === "string") told.push(JSON.parse(message.data));
  });
  const statuses = () => told.splice(0).filter(({ type }) => type === "status");
  await folder.begin();
  await folder.hear({ channel: 1, open: answers.bench.id });
  for (let second = 0; second < 60; second += 1) folder.turn(1000 * second);
  const before = statuses();
  expect(before).toHaveLength(4);
  await folder.hear({ channel: 1, text: JSON.stringify({ type: "took", statuses: 4 }) });
  folder.turn(61_000);
  const [after] = statuses();
  expect(after.tick).toBeGreaterThan(before[3].tick);
});

it("heals, takes it back and refuses what a folder has not, in words", async () => {
  const board = await FolderBoard.connect();
  await board.command({ kind: "step", ticks: 10 });
  await board.command(MASS);
  await board.command({ heal: "all" });
  expect(useBench.getState().bench).toMatchObject({ faults: [], undo: { text: "heal all" } });
  await board.command({ kind: "undo" });
  expect(useBench.getState().bench?.faults.map(({ name, severity }) => [name, severity])).toEqual([
    ["added_mass", 0.05],
  ]);
  const ramp = { ...MASS, profile: { kind: "ramp", duration_ms: 5 } } as const;
  await expect(stream.client.command(ramp as never)).rejects.toThrow("comes as a step of its usual kind");
  await expect(stream.client.command({ set: { "plant.model": "planar" } })).rejects.toThrow("without a server");
});
