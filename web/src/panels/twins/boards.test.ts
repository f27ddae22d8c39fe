import { expect, it } from "vitest";
import type { Signal } from "../../api/types";
import { boardsOf, comparison, twinsOf } from "./boards";

const signals = (...names: string[]): Signal[] =>
  names.map((name, index) => ({ name, index, unit: "um", meaning: "", block: "", kind: "output" }));

it("names a twin for each controller, the same one twice apart", () =>
  expect(twinsOf(["pid", "mrac", "pid"])).toEqual({
    pid: { controller: { kind: "pid" } },
    mrac: { controller: { kind: "mrac" } },
    pid_2: { controller: { kind: "pid" } },
  }));

it("overlays displacement and effort of all boards, and shows the gains of those that have some", () => {
  const boards = boardsOf({ controller: "pid", parameters: { twins: twinsOf(["mrac"]) } });
  expect(boards.map((b) => b.controller)).toEqual(["pid", "mrac"]);
  const strips = comparison(
    boards,
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
