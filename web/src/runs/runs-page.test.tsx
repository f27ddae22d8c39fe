import { screen, waitFor, within } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { showAddress } from "../bench/view-store";
import { Refusal, server } from "../testing/fake-server";
import { recordedAnswer } from "../testing/recorded";
import { mount } from "../testing/render";
import { RunsPage } from "./runs-page";

const run = await recordedAnswer("run");
const sweep = await recordedAnswer("sweep");
const { comparison, trace, points } = await recordedAnswer("campaign");
const second = { ...run, id: "run-2", label: "quiet <b>bench</b>", seeds: [2], created: "2025-12-31T00:00:00Z" };
const campaign = { ...sweep, created: "2025-12-30T00:00:00Z" };

beforeEach(() => {
  vi.spyOn(window, "confirm").mockReturnValue(true);
  server.on("GET", "/scenarios", { scenarios: [{ id: "first-look", title: "First look" }] });
  server.on("GET", "/scenarios/:id", { document: {}, toml: "" });
  server.on("GET", "/runs", { runs: [run, second] });
  server.on("GET", "/sweeps", { sweeps: [campaign] });
  server.on("GET", "/runs/compare", comparison);
  server.on("GET", "/runs/compare/trace", trace);
  server.on("GET", "/sweeps/sweep-1/points", points);
});

async function mountPage(query = "") {
  window.history.replaceState(null, "", `/?page=runs${query}`);
  showAddress();
  const shown = mount(<RunsPage />);
  const jobs = within(screen.getByRole("region", { name: "Runs and campaigns" }));
  await jobs.findByRole("list");
  const result = within(screen.getByRole("region", { name: "Result" }));
  return { ...shown, jobs, result };
}

it("lists runs and campaigns, the newest first and the last included", async () => {
  const { jobs } = await mountPage();
  expect(jobs.getAllByRole("listitem").map((row) => row.querySelector("b")?.textContent)).toEqual([
    run.title,
    "quiet <b>bench</b>",
    "Campaign sweep",
  ]);
});

it("tells runs of a scenario apart by the values that each changes", async () => {
  const changed = [{ path: "events.0.severity", before: 0.5, value: 0.8 }];
  server.on("GET", "/runs", {
    runs: [
      { ...run, changed: [] },
      { ...second, changed },
    ],
  });
  const { jobs } = await mountPage();
  expect(await jobs.findByRole("button", { name: /^quiet .* severity 0\.5 → 0\.8/ })).toBeVisible();
  expect(jobs.getByRole("button", { name: /^First look/ })).not.toHaveTextContent("severity");
});

const NONE = new Refusal(404, "there is none");

it("shows a run of a link that is older than the rows of the list", async () => {
  server.on("GET", "/runs/run-old", { ...run, id: "run-old", label: "an old run" });
  server.on("GET", "/sweeps/run-old", NONE);
  const { result } = await mountPage("&run=run-old");
  expect(await result.findByRole("heading", { name: "an old run" })).toBeVisible();
});

it("says that a link leads to no run", async () => {
  server.on("GET", "/runs/run-none", NONE);
  server.on("GET", "/sweeps/run-none", NONE);
  const { result } = await mountPage("&run=run-none");
  expect(await result.findByText("There is no such run")).toBeVisible();
});

it("shows a run that is chosen: its figures with units, its digest and its files", async () => {
  const { user, jobs, result } = await mountPage();
  await user.click(jobs.getByRole("button", { name: /^quiet/ }));
  expect(window.location.pathname).toBe("/runs/run-2");
  expect(result.getByRole("heading", { name: "quiet <b>bench</b>" })).toBeVisible();
  expect(result.getByRole("row", { name: /^natural frequency.*2\.48378|^f0.*2\.48378|2483\.78/i })).toBeVisible();
  expect(result.getByText("digest digest")).toBeVisible();
  for (const format of ["CSV", "PARQUET", "NPZ", "MAT", "MCAP"])
    expect(result.getByRole("link", { name: format })).toHaveAttribute(
      "href",
      `./api/v1/runs/run-2/trace?format=${format.toLowerCase()}`,
    );
  const count = Object.keys((run.summary as { metrics: object }).metrics).length;
  expect(within(result.getByRole("table")).getAllByRole("row")).toHaveLength(count + 1);
});

it("says what a run warns of, and that it tripped", async () => {
  const summary = { ...run.summary, warnings: ["stvsc: thin"], trip: { reason: "beyond 8 µm", time_ms: 1 } };
  server.on("GET", "/runs", { runs: [{ ...run, summary }] });
  const { jobs, result } = await mountPage("&run=run-1");
  expect(await result.findByText("Warning: stvsc: thin")).toBeVisible();
  expect(result.getByText("Tripped: beyond 8 µm")).toBeVisible();
  expect(jobs.getByText("tripped")).toBeVisible();
});

it("says why a run could not be carried out", async () => {
  server.on("GET", "/runs", {
    runs: [{ ...run, state: "failed", summary: null, error: { message: "no such block" } }],
  });
  const { result } = await mountPage("&run=run-1");
  expect(await result.findByText("It could not be carried out")).toBeVisible();
  expect(result.getByText("no such block")).toBeVisible();
});

it("renames a run", async () => {
  server.on("PATCH", "/runs/run-1", run);
  const { user, result } = await mountPage("&run=run-1");
  await user.type(await result.findByLabelText("Name"), "loud{Enter}");
  expect(server.asked("PATCH", "/runs/run-1")[0].body).toEqual({ label: "loud" });
});

it("compares two that are marked, with signed differences and both traces", async () => {
  const { user, jobs, result } = await mountPage();
  expect(jobs.getByRole("button", { name: "Compare" })).toBeDisabled();
  for (const box of jobs.getAllByRole("checkbox").slice(0, 2)) await user.click(box);
  await user.click(jobs.getByRole("button", { name: "Compare 2" }));
  expect(window.location.pathname).toBe("/runs/run-1,run-2");
  const table = within(await result.findByRole("table"));
  const different = comparison.figures.filter(({ differences }) => differences.some((one) => one !== 0));
  expect(table.getAllByRole("row")).toHaveLength(different.length + 1);
  const rms = comparison.figures.find(({ metric }) => metric === "control.rms_error_um");
  const row = table.getByTitle("control.rms_error_um").closest("tr") as HTMLElement;
  expect(within(row).getAllByRole("cell").at(-1)).toHaveTextContent((rms?.differences[1] ?? 0) > 0 ? /^\+/ : /^−/);
  expect(await result.findByRole("img", { name: "plant.displacement: displacement, µm over time, ms" })).toBeVisible();
  await user.click(result.getByRole("checkbox", { name: /^Only the/ }));
  expect(table.getAllByRole("row")).toHaveLength(comparison.figures.length + 1);
  expect(table.getAllByText("same").length).toBeGreaterThan(0);
});

it("removes what is marked once that is confirmed, and shows it no longer", async () => {
  server.on("POST", "/runs/remove", { removed: 1 });
  server.on("POST", "/sweeps/remove", { removed: 1 });
  const { user, jobs, result } = await mountPage("&run=run-2");
  const [, quiet, last] = jobs.getAllByRole("checkbox");
  await user.click(quiet);
  await user.click(last);
  vi.mocked(window.confirm).mockReturnValueOnce(false);
  await user.click(jobs.getByRole("button", { name: "Remove 2" }));
  expect(server.asked("POST", "/runs/remove")).toEqual([]);
  await user.click(jobs.getByRole("button", { name: "Remove 2" }));
  await waitFor(() => expect(window.location.pathname).toBe("/runs"));
  expect(server.asked("POST", "/runs/remove")[0].body).toEqual({ ids: ["run-2"] });
  expect(server.asked("POST", "/sweeps/remove")[0].body).toEqual({ ids: ["sweep-1"] });
  expect(result.getByText("No result chosen")).toBeVisible();
});

it("cancels a run and a campaign under way, neither of which is removed", async () => {
  server.on("GET", "/runs", { runs: [{ ...run, label: "Busy run", state: "running", progress: 0.25 }] });
  server.on("GET", "/sweeps", { sweeps: [{ ...campaign, state: "queued", done: 0 }] });
  server.on("DELETE", "/runs/run-1", run);
  server.on("DELETE", "/sweeps/sweep-1", new Refusal(409, "It has ended."));
  const { user, jobs } = await mountPage();
  expect(jobs.getByRole("progressbar", { name: "Progress of Busy run" })).toHaveAttribute("aria-valuenow", "25");
  expect(jobs.getByRole("button", { name: "Remove all finished" })).toBeDisabled();
  await user.click(jobs.getByRole("button", { name: "Cancel Busy run" }));
  expect(server.asked("DELETE", "/runs/run-1")).toHaveLength(1);
  await user.click(jobs.getByRole("button", { name: "Cancel Campaign sweep" }));
  expect(await screen.findByText("It has ended.")).toBeVisible();
});

it("asks for the runs of a text, a state and a scenario, and shows all again", async () => {
  const { user, jobs } = await mountPage();
  const last = () => server.asked("GET", "/runs").at(-1)?.query;
  await user.selectOptions(jobs.getByLabelText("State"), "done");
  await user.selectOptions(jobs.getByLabelText("Scenario of the runs"), "first-look");
  server.on("GET", "/runs", { runs: [] });
  server.on("GET", "/sweeps", { sweeps: [] });
  await user.type(jobs.getByRole("searchbox"), "none");
  expect(await jobs.findByText("No run matches")).toBeVisible();
  expect(last()).toEqual({ text: "none", state: "done", scenario: "first-look", limit: "200" });
  expect(server.asked("GET", "/sweeps").at(-1)?.query).toEqual(last());
  await user.click(jobs.getByRole("button", { name: "Show all" }));
  await waitFor(() => expect(jobs.getByText("Nothing has been run yet")).toBeVisible());
  expect(jobs.getByRole("searchbox")).toHaveValue("");
});

it("shows older runs on request, and says that there are some", async () => {
  const rows = Array.from({ length: 210 }, (_, n) => ({
    ...run,
    id: `many-${n}`,
    label: `run ${n}`,
    created: new Date(1e12 - n * 1e3).toISOString(),
  }));
  server.on("GET", "/sweeps", { sweeps: [] });
  server.on("GET", "/runs", ({ query }: { query: Record<string, string> }) => {
    const first = Number(query.after ?? 0);
    const end = first + Number(query.limit);
    const headers = end < 210 ? { Link: `<http://lab/api/v1/runs?after=${end}>; rel="next"` } : undefined;
    return Response.json({ runs: rows.slice(first, end) }, { headers });
  });
  const { user, jobs } = await mountPage();
  const list = jobs.getByRole("list");
  expect(list.children).toHaveLength(200);
  await user.click(jobs.getByText("Show older"));
  await waitFor(() => expect(list.children).toHaveLength(210));
  expect(jobs.queryByText("Show older")).not.toBeInTheDocument();
});
