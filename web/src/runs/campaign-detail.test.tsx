import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { Refusal, server } from "../testing/fake-server";
import { drawOnce } from "../testing/jsdom-gaps";
import { recordedAnswer } from "../testing/recorded";
import { penOf } from "../testing/recording-pen";
import { mount } from "../testing/render";
import { CampaignDetail } from "./campaign-detail";

const { points, picture, density, histogram } = await recordedAnswer("campaign");
const sweep = await recordedAnswer("sweep");
const NOISES = [0.01, 0.02, 0.05, 0.1];
const many = Array.from({ length: 50 }, (_, i) => ({ ...points.points[0], labels: { "sensor.noise_um": i / 1000 } }));

beforeEach(() => {
  server.on("GET", "/sweeps/sweep-1/points", points);
  server.on("GET", "/sweeps/sweep-1/picture", picture);
});

async function mountCampaign(of = sweep) {
  const onChanged = vi.fn();
  const shown = mount(<CampaignDetail sweep={of} onChanged={onChanged} />);
  await shown.user.click(await screen.findByText("All points as a table"));
  const table = screen.getAllByRole("table").at(-1) as HTMLElement;
  const rows = () =>
    within(table)
      .getAllByRole("row")
      .slice(1)
      .map((row) =>
        within(row)
          .getAllByRole("cell")
          .map((cell) => cell.textContent?.replace(/\s/g, " ")),
      );
  const first = () => rows().map(([cell]) => cell);
  return { ...shown, onChanged, table, rows, first };
}

it("says how many runs are done, and offers its files", async () => {
  await mountCampaign();
  expect(screen.getByText(/^4 of 4\sruns · done/)).toBeVisible();
  expect(screen.getByRole("link", { name: "Report" })).toHaveAttribute("href", "./api/v1/sweeps/sweep-1/report");
  expect(screen.getByRole("link", { name: /Python script/ })).toHaveAttribute("href", "./api/v1/sweeps/sweep-1/script");
  expect(screen.getByRole("link", { name: "CSV" })).toHaveAttribute("href", "./api/v1/sweeps/sweep-1/runs?format=csv");
});

it("has a row for each point, the last included, with units in the headings", async () => {
  const { table, rows, first } = await mountCampaign();
  const headings = within(table)
    .getAllByRole("columnheader")
    .map((one) => one.textContent?.replace(/\s/g, " "));
  expect(headings.slice(0, 4)).toEqual(["noise, µm", "runs", "as expected", "tripped"]);
  expect(headings.slice(4)).toEqual([
    "kalman: correct fraction",
    "rms error, pm",
    "kalman: false switches",
    "amplitude, µm",
  ]);
  expect(first()).toEqual(["0.01", "0.02", "0.05", "0.1"]);
  const rms = headings.indexOf("rms error, pm");
  expect(rows()[0].slice(1, 4)).toEqual(["1", "1", "0"]);
  points.points.forEach((point, i) => {
    expect(Number.parseFloat(rows()[i][rms] ?? "")).toBeCloseTo(1e6 * point.metrics["control.rms_error_um"].mean, -1);
  });
});

it("sorts by the heading that is pressed, up and down", async () => {
  const { user, table, first } = await mountCampaign();
  const heading = within(table).getByRole("button", { name: /^noise/ });
  await user.click(heading);
  expect(within(table).getByRole("columnheader", { name: /^noise/ })).toHaveAttribute("aria-sort", "ascending");
  await user.click(heading);
  expect(first()).toEqual(["0.1", "0.05", "0.02", "0.01"]);
  expect(within(table).getByRole("columnheader", { name: /^noise/ })).toHaveAttribute("aria-sort", "descending");
  expect(server.asked("GET", "/sweeps/sweep-1/points")).toHaveLength(1);
});

it("shows the picture first: the figure that varies most over the noise, from zero where zero means something", async () => {
  const { user } = await mountCampaign();
  await drawOnce();
  const figures = within(screen.getByRole("region", { name: "Figures" }));
  expect(screen.getAllByRole("region")[0]).toHaveAccessibleName("Figures");
  const [first] = picture.figures;
  expect(picture.figure).toBe(first);
  const chart = figures.getByRole("img", { name: / over noise/ });
  expect(penOf(chart).words).toEqual(expect.arrayContaining(["0.01", "0.10", "noise, µm"]));
  await user.click(figures.getByRole("combobox", { name: "Figure" }));
  await user.click(screen.getByRole("option", { name: "rms error, µm" }));
  await waitFor(() =>
    expect(server.asked("GET", "/sweeps/sweep-1/picture").at(-1)?.query).toEqual({ figure: "control.rms_error_um" }),
  );
});

it("shows the map of a grid of two numbers, one for each of the rest", async () => {
  const part = (kind: string) => ({
    labels: { "controller.kind": kind },
    x: [0.01, 0.01, 0.1, 0.1],
    y: [5, 10, 5, 10],
    mean: [1, 2, 3, 4],
    std: [0, 0, 0, 0],
  });
  const map = { kind: "map", up: "faults.mass_pct", low: 0, high: 4, parts: [part("pid"), part("mrac")] };
  server.on("GET", "/sweeps/sweep-1/picture", { ...picture, figure: "control.rms_error_um", ...map });
  await mountCampaign();
  const charts = within(screen.getByRole("region", { name: "Figures" })).getAllByRole("img");
  expect(charts.map((chart) => chart.getAttribute("aria-label"))).toEqual([
    "rms error, µm over noise and mass: kind pid",
    "rms error, µm over noise and mass: kind mrac",
  ]);
});

it("ranks the numbers of a hypercube, and shows the points over the one that is chosen", async () => {
  const parts = [{ labels: {}, x: [0.01, 0.02, 0.03], y: [], mean: [1, 2, 3], std: [0, 0, 0] }];
  const ranking = [
    { name: "sensor.noise_um", correlation: 0.9 },
    { name: "device.mass_kg", correlation: -0.1 },
  ];
  const found = { kind: "ranking", figure: "control.rms_error_um", low: 0, high: 4, parts, ranking, chance: 0.3 };
  server.on("GET", "/sweeps/sweep-1/picture", { ...picture, ...found });
  const { user } = await mountCampaign();
  const figures = within(screen.getByRole("region", { name: "Figures" }));
  expect(figures.getByRole("img", { name: /what it goes with: noise: 0.90; mass: −0.10/ })).toBeVisible();
  expect(figures.getByRole("img", { name: /^rms error over noise/ })).toBeVisible();
  await user.click(figures.getByRole("combobox", { name: "Across" }));
  await user.click(screen.getByRole("option", { name: "mass" }));
  await waitFor(() =>
    expect(server.asked("GET", "/sweeps/sweep-1/picture").at(-1)?.query).toEqual({
      figure: "control.rms_error_um",
      across: "device.mass_kg",
    }),
  );
});

it("draws the curves and the table of the diagnoser, by its title and its hypotheses in words", async () => {
  await mountCampaign();
  expect(screen.getByRole("img", { name: /Receiver operating characteristic/ })).toBeVisible();
  expect(screen.getByRole("img", { name: /Detection delay/ })).toBeVisible();
  expect(screen.getByText(/^Kalman bank .*truth down/)).toBeVisible();
  expect(screen.getByRole("columnheader", { name: "mass +5\u00a0%" })).toBeVisible();
});

it("shows the confusion of the point that is chosen", async () => {
  const last = points.points[3];
  const [, ...others] = last.diagnosis.kalman.confusion;
  const tally = { ...last.diagnosis.kalman, missed: 3, confusion: [[77, 0, 0, 0, 0, 0], ...others] };
  const found = [...points.points.slice(0, 3), { ...last, diagnosis: { kalman: tally } }];
  server.on("GET", "/sweeps/sweep-1/points", { ...points, points: found });
  const { user } = await mountCampaign();
  const diagnosis = within(screen.getByRole("region", { name: "Diagnosis" }));
  const options = within(diagnosis.getByLabelText("Confusion at")).getAllByRole("option");
  expect(options.map((one) => one.textContent?.replace(/\s/g, " "))).toEqual(NOISES.map((n) => `noise ${n} µm`));
  expect(diagnosis.queryByTitle(/^77 of 77/)).not.toBeInTheDocument();
  await user.selectOptions(diagnosis.getByLabelText("Confusion at"), options[3]);
  expect(diagnosis.getByTitle(/^77 of 77/)).toBeVisible();
  expect(diagnosis.getByText("3 changes were never found.")).toBeVisible();
});

it("says once what its runs could not do and what they warn of", async () => {
  const errors = ["drive.kind: analogue is for open_loop only"];
  const warnings = ["stvsc: the boundary layer is thin"];
  server.on("GET", "/sweeps/sweep-1/points", {
    ...points,
    points: points.points.map((point, i) => ({ ...point, warnings, ...(i > 1 ? { errors, metrics: {}, ok: 0 } : {}) })),
  });
  const { rows } = await mountCampaign();
  expect(screen.getByText(errors[0])).toBeVisible();
  expect(screen.getByText(`Warning: ${warnings[0]}`)).toBeVisible();
  expect(rows()).toHaveLength(4);
  expect(rows()[3]).toContain("–");
});

it("renames the campaign, and shows the words of a refusal", async () => {
  server.on("PATCH", "/sweeps/sweep-1", sweep);
  const { user, onChanged } = await mountCampaign();
  const name = screen.getByLabelText("Name");
  await user.type(name, "Loud{Enter}");
  expect(server.asked("PATCH", "/sweeps/sweep-1")[0].body).toEqual({ label: "Loud" });
  await waitFor(() => expect(onChanged).toHaveBeenCalledTimes(1));
  await user.type(name, "er{Escape}");
  expect(name).toHaveValue("");
  server.on("PATCH", "/sweeps/sweep-1", new Refusal(404, "There is no such campaign."));
  await user.type(name, "x{Enter}");
  expect(await screen.findByText("There is no such campaign.")).toBeVisible();
});

it("reads many points page by page, sorted by the server", async () => {
  server.on("GET", "/sweeps/sweep-1/points", { ...points, points: many, found: 250 });
  const { user, table } = await mountCampaign();
  expect(await screen.findByText("Points 1 to 50 of 250")).toBeVisible();
  await user.click(screen.getByRole("button", { name: "Page 5" }));
  expect(await screen.findByText("Points 201 to 250 of 250")).toBeVisible();
  const asked = () => server.asked("GET", "/sweeps/sweep-1/points").at(-1)?.query;
  expect(asked()).toMatchObject({ limit: "50", offset: "200" });
  await user.click(within(table).getByRole("button", { name: /^noise/ }));
  expect(await screen.findByText("Points 1 to 50 of 250")).toBeVisible();
  await user.click(within(table).getByRole("button", { name: /^noise/ }));
  await waitFor(() =>
    expect(asked()).toEqual({ limit: "50", offset: "0", sort: "sensor.noise_um", descending: "true" }),
  );
});

it("shows how fifty runs are spread: over two quantities, or counted over one", async () => {
  server.on("GET", "/sweeps/sweep-1/distribution", ({ query }: { query: Record<string, string> }) =>
    query.y ? density : histogram,
  );
  const { user } = await mountCampaign({ ...sweep, runs: 60, done: 60 });
  const spread = within(screen.getByRole("region", { name: "Distribution of runs" }));
  expect(await spread.findByRole("img", { name: /^(Density of runs|Runs): .* over noise; 4\sruns/ })).toBeVisible();
  await user.selectOptions(spread.getByLabelText("Up"), "number of runs");
  expect(await spread.findByRole("img", { name: /^Histogram of noise; 4\sruns/ })).toBeVisible();
  expect(server.asked("GET", "/sweeps/sweep-1/distribution").at(-1)?.query).toEqual({ x: "sensor.noise_um" });
});

it("says that nothing is done yet, and why a campaign failed", async () => {
  server.on("GET", "/sweeps/sweep-1/points", { ...points, points: [], found: 0 });
  const failed = {
    ...sweep,
    done: 0,
    state: "failed" as const,
    error: { code: "failed", message: "the disk is full" },
  };
  mount(<CampaignDetail sweep={failed} onChanged={() => undefined} />);
  expect(await screen.findByText("No result")).toBeVisible();
  expect(screen.getByText(/failed: the disk is full$/)).toBeVisible();
});
