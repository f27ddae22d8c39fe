import { screen, waitFor } from "@testing-library/react";
import { expect, it } from "vitest";
import type { RateReadout } from "../../api/types";
import { Refusal, server } from "../../testing/fake-server";
import { connect } from "../../testing/fake-transport";
import { recordedBench } from "../../testing/recorded";
import { penOf } from "../../testing/recording-pen";
import { be, mount } from "../../testing/render";
import { AllanPanel } from "./allan-panel";

const { bench } = await recordedBench("gyroscope");
const measured: typeof bench = {
  ...bench,
  parameters: { ...bench.parameters, readouts: { noise: { kind: "allan" } } },
};
const octaves = Array.from({ length: 9 }, (_, i) => ({
  tau_s: 0.01 * 2 ** i,
  deviation_deg_h: 900 / 2 ** (i / 2),
  pairs: 100,
}));
const readout: RateReadout = {
  tick: 2000,
  record_s: 12.345,
  octaves,
  figures: [
    { letter: "N", name: "angle random walk", unit: "deg/h^(1/2)", value: 0.2, error: 0.02, reason: "", true: 0.19 },
    {
      letter: "B",
      name: "bias instability",
      unit: "deg/h",
      value: null,
      error: null,
      reason: "the record is too short",
      true: 3,
    },
  ],
  from_s: 0.01,
  to_s: 1,
};

function mountPanel(of = measured) {
  const board = connect(of);
  return { board, ...mount(<AllanPanel />) };
}

it("shows the record, the plot over its averaging times, and the figures with their grade", async () => {
  server.on("GET", "/benches/:id/readouts/:name", readout);
  mountPanel();
  const plot = await screen.findByRole("img", { name: /over 9\saveraging times$/ });
  expect(screen.getByText(/^Record of 12\.3[45]\ss$/)).toBeVisible();
  expect(screen.getByText("Pairs of means begin an eighth of the averaging time apart.")).toBeVisible();
  expect(screen.getByRole("row", { name: /^Angle random walk N/ })).toHaveTextContent(/tactical grade/);
  expect(screen.getByRole("row", { name: /^Bias instability B/ })).toHaveTextContent("The record is too short.");
  expect(penOf(plot).words).toEqual(expect.arrayContaining(["averaging time", "deviation, deg/h"]));
  expect(server.requests.map(({ path }) => path)).toContain("/benches/gyroscope/readouts/noise");
});

it("lets the bench run as fast as possible", async () => {
  server.on("GET", "/benches/:id/readouts/:name", readout);
  const { board, user } = mountPanel();
  await user.click(screen.getByRole("button", { name: "Gather as fast as possible" }));
  expect(board.commands).toEqual([{ kind: "time_scale", value: null }]);
  board.status({ time_scale: null });
  expect(screen.queryByRole("button", { name: "Gather as fast as possible" })).not.toBeInTheDocument();
});

it("says why there is no read-out", async () => {
  server.on("GET", "/benches/:id/readouts/:name", new Refusal(409, "The read-out has no sample yet."));
  mountPanel();
  expect(await screen.findByText("The read-out has no sample yet.")).toBeVisible();
});

it("begins again with a read-out, for who teaches", async () => {
  server.on("POST", "/benches/:id/variant", { ...bench, id: "next" });
  const { user, unmount } = mountPanel(bench);
  await user.click(screen.getByRole("button", { name: "Restart with an Allan read-out" }));
  await waitFor(() => expect(server.asked("POST", "/benches/gyroscope/variant")).toHaveLength(1));
  expect(server.asked("POST", "/benches/gyroscope/variant")[0].body).toEqual({
    set: { "readouts.allan.kind": "allan" },
    repeat: false,
  });
  unmount();
  be("student");
  mountPanel(bench);
  expect(screen.queryByRole("button", { name: "Restart with an Allan read-out" })).not.toBeInTheDocument();
});

it("offers a watcher no other speed", async () => {
  be("watcher");
  server.on("GET", "/benches/:id/readouts/:name", readout);
  mountPanel();
  await screen.findByRole("row", { name: /^Angle random walk/ });
  expect(screen.queryByRole("button", { name: "Gather as fast as possible" })).not.toBeInTheDocument();
});
