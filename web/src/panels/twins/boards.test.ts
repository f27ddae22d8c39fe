import { expect, it } from "vitest";
import type { Signal } from "../../api/types";
import { boardsOf, comparedOn, comparison, twinsOf } from "./boards";

const signals = (...names: string[]): Signal[] =>
  names.map((name, index) => ({ name, index, unit: "um", meaning: "", block: "", kind: "output" }));

it("names a twin for each controller, the same one twice apart", () =>
  expect(twinsOf(["pid", "mrac", "pid"], () => undefined)).toEqual({
    pid: { controller: { kind: "pid" } },
    mrac: { controller: { kind: "mrac" } },
    pid_2: { controller: { kind: "pid" } },
  }));

it("overlays displacement and effort of all boards, and shows the gains of those that have some", () => {
  const boards = boardsOf({ controller: "pid", parameters: { twins: twinsOf(["mrac"], () => undefined) } });
  expect(boards.map((b) => b.controller)).toEqual(["pid", "mrac"]);
  const strips = comparison(
    boards,
    comparedOn([]),
    signals(
      "plant.displacement",
      "model.displacement",
      "drive.voltage",
      "mrac:plant.displacement",
      "mrac:drive.voltage",
      "mrac:mrac.gain.r",
      "mrac:mrac.gain_ideal.r",
      "mrac.gain.r",
    ),
  );
  expect(strips.map((s) => s.title)).toEqual(["displacement", "effort", "mrac: gain r"]);
  expect(strips[0].rivals).toEqual([{ signal: "mrac:plant.displacement", slot: 2 }]);
  expect(strips[2]).toMatchObject({ signal: "mrac:mrac.gain.r", ideal: "mrac:mrac.gain_ideal.r", slot: 2 });
});

it("compares gyroscopes by the rate each reads, what moves and what pushes; one may differ in the drive alone", () => {
  const twins = twinsOf(["rebalance", "forced"], (kind) => (kind === "forced" ? "drive" : undefined));
  expect(twins).toEqual({ rebalance: { controller: { kind: "rebalance" } }, forced: { slots: { drive: "forced" } } });
  const boards = boardsOf({ controller: "open", parameters: { twins } });
  expect(boards.map((b) => [b.chosen, b.controller])).toEqual([
    ["open", "open"],
    ["rebalance", "rebalance"],
    ["forced", "open"],
  ]);
  const each = ["", "rebalance:", "forced:"].flatMap((prefix) =>
    ["plant.x", "plant.y", "drive.x.force", "drive.y.force"].map((name) => prefix + name),
  );
  const strips = comparison(
    boards,
    comparedOn(["x", "y"]),
    signals("rate.rate", "open.rate", "rebalance:rebalance.rate", "forced:open.rate", ...each),
  );
  expect(strips.map((s) => s.title)).toEqual(["rate", "x", "y", "force along x", "force along y"]);
  expect(strips[0]).toMatchObject({ signal: "open.rate", ideal: "rate.rate" });
  expect(strips[0].rivals?.map((r) => r.signal)).toEqual(["rebalance:rebalance.rate", "forced:open.rate"]);
});
