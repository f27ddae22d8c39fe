// @vitest-environment jsdom
import { renderToStaticMarkup } from "react-dom/server";
import { expect, it } from "vitest";
import type { GalleryCard } from "../api/types";
import { ExpectationTable } from "./expectation-table";

type Entry = GalleryCard["expectations"][number];

const entry = (metric: string, measured: number | null, rest: Partial<Entry> = {}): Entry => ({
  metric,
  measured,
  published: "",
  published_value: null,
  expected: ">= -1",
  expected_words: "≥ −1",
  ok: true,
  verdict: "reproduced",
  fitted: [],
  reason: "",
  note: "",
  comparator: "",
  pid_too: false,
  ...rest,
});

function table(...entries: Entry[]): string[][] {
  const page = document.createElement("div");
  page.innerHTML = renderToStaticMarkup(<ExpectationTable entries={entries} verdict="reproduced" />);
  return [...page.querySelectorAll("tr")].map((row) => [...row.children].map((cell) => cell.textContent ?? ""));
}

const MEASURED = 2;

it("keeps a share from reading as all beside errors that were counted, and counts whole", () => {
  const rows = table(
    entry("diagnosis.kalman.correct_fraction", 0.99997),
    entry("diagnosis.kalman.false_switches", 53),
    entry("control.rms_error_um", 0.0123456),
  );
  expect(rows.slice(1).map((row) => row[MEASURED])).toEqual(["0.99997", "53", "12.35\u00a0nm"]);
});

it("says a figure that was not measured by a dash", () => {
  const other = entry("control.effort_ratio", 1.8, { open_loop: 1 });
  expect(table(entry("control.rms_error_um", null), other)[1].slice(MEASURED)).toEqual(["–", "–"]);
});

it("has no column of the open loop where no figure has one", () => {
  expect(table(entry("control.rms_error_um", null))[0]).toEqual(["figure", "expected", "measured"]);
});

it("has what the open loop gives beside each figure, and a PID only where one is compared", () => {
  const plain = entry("control.effort_ratio", 1.8, { open_loop: 1 });
  expect(table(plain)).toEqual([
    ["figure", "expected", "measured", "open loop"],
    ["effort ratio", "≥ −1", "1.800", "1"],
  ]);
  const [head, , row] = table(plain, entry("control.settling_ms", 9.7, { open_loop: 100, pid: 20 }));
  expect([head.at(-1), row.at(-1)]).toEqual(["PID", "20\u00a0ms"]);
});

it("names the PID of a row, and says where it meets the claim too", () => {
  const comparator = "best PID of 12: pole 2, feed-forward 1";
  const rest = { pid: 0.037, comparator, verdict: "reproduced, by a PID too" as const };
  const [, met, missed] = table(
    entry("control.tail_rms_error_um", 0.001, { ...rest, pid_too: true }),
    entry("control.tail_rms_error_um", 0.001, { ...rest, verdict: "reproduced" }),
  );
  expect(met[0]).toContain(`${comparator}, meets the claim too`);
  expect(met[0]).toContain("reproduced, by a PID too");
  expect(missed[0]).toContain(comparator);
  expect(missed[0]).not.toContain("meets");
});

it("shows words of the text and a verdict of its own under the figure", () => {
  const own = entry("control.effort_ratio", 1.8, { published: "almost 80 % stronger", verdict: "ours" });
  expect(table(own)[1][0]).toBe("effort ratiopublished: almost 80\u00a0% strongerours");
});

it("has words for an expectation that was kept without them", () => {
  const kept = {
    ...entry("control.rms_error_um", 0.01, { expected: ">= 0.001 and <= 0.02" }),
    expected_words: undefined,
  };
  expect(table(kept as never)[1][1]).toBe("≥\u00a00.001\u00a0µm and ≤\u00a00.02\u00a0µm");
});
