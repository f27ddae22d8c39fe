import { screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedAnswer, recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { be, mount } from "../../testing/render";
import { saveFile } from "../../ui/save-file";
import { BehaviourPanel } from "./behaviour-panel";

vi.mock("../../ui/save-file", () => ({ saveFile: vi.fn(), pngOf: vi.fn() }));

const { bench } = await recordedBench("first-look");
const catalog = await recordedAnswer("catalog");
const NAMES = ["healthy", "b+30"];
const signal = (name: string, unit = "1") => ({ ...bench.signals[0], name, unit, block: name.split(".")[0] });
const drawn = {
  ...bench,
  diagnosers: {
    consistency: { kind: "consistency", names: NAMES, factors: [{}, { damping: 1.3 }] },
    regions: { kind: "regions", names: [], factors: [] },
  },
  signals: [
    ...bench.signals,
    signal("consistency.verdict"),
    ...NAMES.flatMap((name) => ["sine", "cosine", "consistent"].map((port) => signal(`consistency.${port}.${name}`))),
    signal("regions.loss"),
    signal("regions.region"),
  ],
} as unknown as typeof bench;

/** The distance of the measured output from each behaviour. */
const sets = (verdict: number, [healthy, damped]: readonly [number, number]) => ({
  "consistency.verdict": () => verdict,
  "consistency.sine.healthy": () => healthy,
  "consistency.cosine.healthy": () => 0,
  "consistency.consistent.healthy": () => Number(healthy < 1),
  "consistency.sine.b+30": () => damped,
  "consistency.cosine.b+30": () => 0,
  "consistency.consistent.b+30": () => Number(damped < 1),
});

beforeEach(() => {
  server.on("GET", "/catalog", catalog);
  server.on("POST", "/benches/:id/variant", { ...bench, id: "next" });
});

function mountPanel(of = drawn) {
  vi.useFakeTimers({ toFake: ["performance"] });
  const board = connect(of);
  const { user } = mount(<BehaviourPanel />);
  const draw = async (values: Record<string, () => number>) => {
    vi.advanceTimersByTime(250);
    board.frame(values, { head: 3000 });
    await drawOnce();
  };
  return { board, user, draw, pen: () => penOf(screen.getByRole("img")) };
}
const textOf = (file: Blob) =>
  new Promise<string>((done) => {
    const reader = new FileReader();
    reader.onload = () => done(String(reader.result));
    reader.readAsText(file);
  });
const said = () => screen.getByTestId("behaviour-words");

it("says to which behaviour input and output belong, and the verdict", async () => {
  const { draw, pen } = mountPanel();
  await draw(sets(0, [0.2, 5]));
  expect(said()).toHaveTextContent("Input and output belong to the behaviour: healthy. The verdict: no fault.");
  const before = pen().marks.map(({ points }) => points);
  await draw(sets(2, [5, 0.3]));
  expect(said()).toHaveTextContent(
    /^Input and output belong to the behaviour: damping \+30\s%\. The verdict: a fault is isolated\.$/,
  );
  expect(pen().marks.map(({ points }) => points)).not.toEqual(before);
});

it("titles its axes and names its behaviours, on the page and as a picture", async () => {
  const { user, draw, pen } = mountPanel();
  await draw(sets(2, [5, 0.3]));
  expect(pen().words).toEqual(expect.arrayContaining(["output by its cosine, in limits", "b+30", "healthy"]));
  await user.click(screen.getByRole("button", { name: "Export" }));
  await user.click(await screen.findByText("SVG"));
  await waitFor(() => expect(saveFile).toHaveBeenCalled());
  const [name, content] = vi.mocked(saveFile).mock.calls[0];
  expect(name).toMatch(/\.svg$/);
  const svg = await textOf(content);
  expect(svg).toContain("output by its cosine, in limits");
  expect(svg).toContain("b+30");
});

it("says in which region of performance the device is, with the limits drawn", async () => {
  const { board, user, draw } = mountPanel();
  await user.selectOptions(screen.getByRole("combobox", { name: "Diagnoser drawn" }), "regions");
  expect(board.subscriptions[0].signals).toEqual(["regions.loss", "regions.region", "sensor.displacement"]);
  await draw({ "regions.loss": () => 0.115, "regions.region": () => 1, "sensor.displacement": () => -2.25 });
  expect(said()).toHaveTextContent(
    /^Performance is degraded: 11\.5\s% from the healthy motion, at most 2\.25\sµm from rest\.$/,
  );
  await draw({ "regions.loss": () => 0.9, "regions.region": () => 3, "sensor.displacement": () => 7 });
  expect(said()).toHaveTextContent(/^The device is in danger: 90\.0\s%/);
});

it.each([
  ["a test of consistency", "consistency"],
  ["regions of performance", "regions"],
])("begins again with %s", async (words, kind) => {
  const { user } = mountPanel(bench);
  await user.click(screen.getByRole("button", { name: `Restart with ${words}` }));
  await waitFor(() => expect(server.asked("POST", "/benches/first-look/variant")).toHaveLength(1));
  expect(server.asked("POST", "/benches/first-look/variant")[0].body).toEqual({
    set: { [`diagnosers.${kind}`]: { kind } },
    repeat: false,
  });
});

it("begins nothing for a student, nor in a replay", () => {
  be("student");
  mountPanel(bench);
  expect(screen.getByText("No behaviour to draw")).toBeVisible();
  expect(screen.queryByRole("button", { name: /^Begin again/ })).not.toBeInTheDocument();
});
