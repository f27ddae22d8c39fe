// @vitest-environment jsdom
import { renderToStaticMarkup } from "react-dom/server";
import { expect, it } from "vitest";
import type { GalleryCard } from "../api/types";
import { ExpectationTable } from "./expectation-table";

type Entry = GalleryCard["expectations"][number];

const entry = (metric: string, measured: number | null): Entry => ({
  metric,
  measured,
  published: "",
  expected: ">= -1",
  ok: true,
  verdict: "reproduced",
  note: "",
});

function measured(...entries: Entry[]): (string | null)[] {
  const page = document.createElement("div");
  page.innerHTML = renderToStaticMarkup(<ExpectationTable entries={entries} verdict="reproduced" />);
  return [...page.querySelectorAll("tbody tr")].map((row) => row.lastElementChild?.textContent ?? null);
}

it("keeps a share from reading as all beside errors that were counted, and counts whole", () => {
  const shown = measured(
    entry("diagnosis.kalman.correct_fraction", 0.99997),
    entry("diagnosis.kalman.false_switches", 53),
    entry("control.rms_error_um", 0.0123456),
  );
  expect(shown).toEqual(["0.99997", "53", "0.01235"]);
});

it("says a figure that was not measured by a dash", () => {
  expect(measured(entry("control.rms_error_um", null))).toEqual(["–"]);
});
