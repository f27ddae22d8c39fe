import { expect, test } from "../lab";
import { seriousViolations } from "../serious-violations";

const NOISES = Array.from({ length: 250 }, (_, i) => (i + 1) / 1000);
const CAMPAIGN = {
  schema: 1,
  id: "many",
  scenario: "first-look",
  set: { samples: 20 },
  seeds: "1:9",
  grid: { "sensor.noise_um": NOISES },
};

test("a campaign of many points is read page by page, and its runs as a density", async ({ page, server }) => {
  const run = await server.ask<{ id: string }>("POST", "/runs", { scenario: "first-look", set: { samples: 20 } });
  const stateOfRun = async () => (await server.ask<{ state: string }>("GET", `/runs/${run.id}`)).state;
  await expect.poll(stateOfRun, "the worker has started").toBe("done");
  const { id } = await server.ask<{ id: string }>("POST", "/sweeps", { sweep: CAMPAIGN });
  const ask = () => server.ask<{ state: string; done: number }>("GET", `/sweeps/${id}`);
  for (let ended = 225; ended < 2250; ended += 225)
    await expect.poll(async () => (await ask()).done).toBeGreaterThanOrEqual(ended);
  await expect.poll(async () => (await ask()).state).toBe("done");
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?page=runs&sweep=${id}`);
  const result = page.getByRole("region", { name: "Result" });
  await expect(result.getByText("of 2250 runs · done")).toBeVisible();
  await result.getByText("All points as a table").click();
  const rows = result.locator("details").getByRole("table").locator("tbody tr");
  await expect(rows).toHaveCount(50);
  const shown = result.getByText(/^Points/);
  await expect(shown).toHaveText("Points 1 to 50 of 250");

  await result.getByRole("button", { name: "Page 5" }).click();
  await expect(shown).toHaveText("Points 201 to 250 of 250");
  await expect(rows).toHaveCount(50);
  // sorted by the server: the noisiest of all comes first, not the noisiest of the page
  const noise = result.getByRole("button", { name: /^noise/ });
  await noise.click();
  await expect(shown).toHaveText("Points 1 to 50 of 250");
  await noise.press("Enter");
  await expect(rows.first()).toContainText(/^0\.25/);
  await expect(result.getByRole("columnheader", { name: /^noise/ })).toHaveAttribute("aria-sort", "descending");

  const spread = result.getByRole("region", { name: "Distribution of runs" });
  await expect(spread.getByRole("img", { name: /^Density of runs: .* over noise; 2250 runs/ })).toBeVisible();
  await expect(spread.getByText("runs in a cell: 1")).toBeVisible();
  await spread.getByRole("combobox", { name: "Up" }).selectOption("number of runs");
  const histogram = spread.getByRole("img", { name: /^Histogram of noise; 2250 runs/ });
  await expect(histogram).toBeVisible();
  await histogram.hover({ position: { x: 200, y: 100 } });
  await expect(spread.locator("output")).toContainText(/noise .* to .*: \d+\sruns/);
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
});
