import { screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { Refusal, server } from "../testing/fake-server";
import { recordedAnswer } from "../testing/recorded";
import { mount } from "../testing/render";
import { BenchmarkPage } from "./benchmark-page";

const benchmark = await recordedAnswer("benchmark");
const catalog = await recordedAnswer("catalog");
const [known, severity] = benchmark.results;
beforeEach(() => {
  server.on("GET", "/benchmarks/mems-diag-1", benchmark);
  server.on("GET", "/catalog", catalog);
});
const titleOf = (unit: string) =>
  catalog.blocks.find(({ family, name }) => family === "diagnose" && name === unit)?.title;

const cells = (row: HTMLElement) =>
  within(row)
    .getAllByRole("cell")
    .map((cell) => cell.textContent?.replace(/\s/g, " "));

it("has a row for each diagnoser in the order of the server, with intervals, shares and times", async () => {
  mount(<BenchmarkPage />);
  const table = within(await screen.findByRole("table"));
  await table.findByRole("rowheader", { name: titleOf(known.rows[0].unit) });
  const rows = table.getAllByRole("row").slice(1);
  expect(rows.map((row) => within(row).getByRole("rowheader").textContent)).toEqual(
    known.rows.map(({ unit }) => titleOf(unit)),
  );
  const first = cells(rows[0]);
  expect(first[0]).toBe("1");
  expect(first[1]).toBe("0.022 ± 0.003");
  expect(first[3]).toBe("12 ± 3");
  expect(first[4]).toBe("0.0 %");
  expect(first.at(-2)).toBe("168 (1.45)");
});

it("gives no rank and no score to a diagnoser without probabilities", async () => {
  const rows = known.rows.map((row, i) => (i === 3 ? { ...row, log_score: null, brier: null } : row));
  server.on("GET", "/benchmarks/mems-diag-1", { ...benchmark, results: [{ ...known, rows }, severity] });
  mount(<BenchmarkPage />);
  const last = within(await screen.findByRole("table"))
    .getAllByRole("row")
    .at(-1) as HTMLElement;
  expect(cells(last).slice(0, 3)).toEqual(["–", "–", "–"]);
});

it("shows another track with its question, and what is left out of it", async () => {
  const { user } = mount(<BenchmarkPage />);
  await user.selectOptions(await screen.findByRole("combobox", { name: "Track" }), severity.title);
  expect(screen.getByRole("heading", { name: severity.question })).toBeVisible();
  expect(
    screen.getByText(new RegExp(`${titleOf("axes_bank")} is not scored: it is for plants with axes`)),
  ).toBeVisible();
  expect(
    screen.getByRole("img", { name: /^Reliability.*: share that was right over probability said$/ }),
  ).toBeVisible();
  expect(
    screen.getByRole("img", { name: "Faults found: share found by then over samples since the fault" }),
  ).toBeVisible();
});

it("says that the table did not come, and asks again", async () => {
  server.on("GET", "/benchmarks/mems-diag-1", new Refusal(503, "The service is busy."));
  const { user } = mount(<BenchmarkPage />);
  expect(await screen.findByText(/The service is busy/)).toBeVisible();
  server.on("GET", "/benchmarks/mems-diag-1", benchmark);
  await user.click(screen.getByRole("button", { name: /again/i }));
  expect(await screen.findByRole("table")).toBeVisible();
});
