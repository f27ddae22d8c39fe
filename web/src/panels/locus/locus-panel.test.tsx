import { screen } from "@testing-library/react";
import { expect, it, vi } from "vitest";
import { connect } from "../../testing/fake-transport";
import { drawOnce } from "../../testing/jsdom-gaps";
import { recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { mount } from "../../testing/render";
import { LocusPanel } from "./locus-panel";

const { bench, frames } = await recordedBench("gyroscope");
const swing = (tiltDeg: number, turn = 0) => ({
  "plant.x": (tick: number) => 3 * Math.sin((tick + turn) / 5),
  "plant.y": (tick: number) => 3 * Math.tan((tiltDeg * Math.PI) / 180) * Math.sin((tick + turn) / 5),
});

function mountPanel(of = bench) {
  vi.useFakeTimers({ toFake: ["performance"] });
  const board = connect(of);
  return { board, ...mount(<LocusPanel />), pen: () => penOf(screen.getByRole("img")) };
}

it("says the tilt of the long axis, and draws the path anew with each frame", async () => {
  const { board, pen } = mountPanel();
  vi.advanceTimersByTime(250);
  board.frame(swing(-0.25), { head: 1000 });
  await drawOnce();
  expect(screen.getByTestId("tilt")).toHaveTextContent(/^−0\.250°$/);
  const before = pen().areas().at(-1)?.points;
  vi.advanceTimersByTime(250);
  board.frame(swing(5, 8), { head: 1000 });
  await drawOnce();
  expect(pen().areas().at(-1)?.points).not.toEqual(before);
  expect(screen.getByTestId("tilt")).toHaveTextContent(/^5\.000°$/);
});

it("titles its axes with the unit of the motion, and says by how much y is stretched", async () => {
  const { board, user, pen } = mountPanel();
  board.frame(swing(1), { head: 1000 });
  await drawOnce();
  expect(pen().words).toEqual(expect.arrayContaining(["x, µm", "y, nm (×60)"]));
  await user.click(screen.getByRole("radio", { name: "x and y alike" }));
  board.frame(swing(1), { head: 1000 });
  await drawOnce();
  expect(pen().words).toEqual(expect.arrayContaining(["x, µm", "y, µm"]));
});

it.each([
  ["open_loop_rate", /quadrature.*ellipse/],
  ["force_to_rebalance", /force it needs for this is the rate/],
  ["whole_angle", /turns back/],
])("says in words what the path tells under %s", (controller, words) => {
  mountPanel({ ...bench, controller });
  expect(screen.getByText(words)).toBeVisible();
});

it("says that the mass is at rest", async () => {
  const { board } = mountPanel();
  vi.advanceTimersByTime(250);
  board.frame({ "plant.x": () => 0, "plant.y": () => 0 }, { head: 1000 });
  await drawOnce();
  expect(screen.getByTestId("tilt")).toHaveTextContent("at rest");
});

it("stretches y to its own scale, unless both are to be alike", async () => {
  const { board, user, pen } = mountPanel();
  board.frame(swing(1), { head: 1000 });
  await drawOnce();
  const height = () => {
    const ys = pen()
      .lines()
      .flatMap(({ points, dashes, colour }) =>
        dashes.length === 0 && points.length > 20 && colour ? points.map(([, y]) => y) : [],
      );
    return Math.max(...ys) - Math.min(...ys);
  };
  const stretched = height();
  await user.click(screen.getByRole("radio", { name: "x and y alike" }));
  board.frame(swing(1), { head: 1000 });
  await drawOnce();
  expect(stretched).toBeGreaterThan(10 * height());
});

it("subscribes to x and y as long as the path is", async () => {
  const { board, user } = mountPanel();
  expect(board.subscriptions).toEqual([{ mode: "roll", signals: frames.scope.signals, window_ms: 2, width: 200 }]);
  await user.selectOptions(screen.getByRole("combobox", { name: "Length of the path" }), "10");
  expect(board.subscriptions[0]).toMatchObject({ window_ms: 10, width: 1000 });
});

it("draws a partner beside the mass", () => {
  const partners = ["x", "y"].map((axis) => ({ ...bench.signals[0], name: `plant.partner_${axis}` }));
  const axes = ["x", "y", "partner_x", "partner_y"];
  const { board } = mountPanel({ ...bench, axes, signals: [...bench.signals, ...partners] });
  expect(board.subscriptions[0].signals).toEqual(["plant.x", "plant.y", "plant.partner_x", "plant.partner_y"]);
  expect(screen.getAllByTestId("tilt")).toHaveLength(2);
});
