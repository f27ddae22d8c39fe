import { addressOf, expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("a run is started from the page, and its files are offered", async ({ page, server }) => {
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?page=runs`);
  await page.getByRole("button", { name: "Change a value" }).click();
  await page.getByRole("combobox", { name: "With other values 1: path" }).fill("sensor.noise");
  await page.getByRole("option", { name: "sensor.noise_um" }).click();
  await page.getByRole("textbox", { name: "sensor.noise_um: value" }).fill("-1");
  await page.getByRole("form", { name: "Start" }).getByRole("button", { name: "Run", exact: true }).click();
  await expect(page.getByRole("form").getByRole("alert")).toContainText("sensor.noise_um");

  await page.getByRole("textbox", { name: "sensor.noise_um: value" }).fill("0.06");
  await page.getByRole("checkbox", { name: "Keep all signals" }).check();
  await page.getByRole("form", { name: "Start" }).getByRole("button", { name: "Run", exact: true }).click();
  const result = page.getByRole("region", { name: "Result" });
  await expect(page).toHaveURL(/[?&]run=/);
  const id = new URL(page.url()).searchParams.get("run");
  const state = () => server.ask<{ state: string }>("GET", `/runs/${id}`).then((found) => found.state);
  await expect.poll(state, { timeout: 120_000 }).toBe("done");
  await expect(result.getByText("Expectations")).toBeVisible();
  const run = await server.ask<{ all: boolean; summary: { digest: string } }>("GET", `/runs/${id}`);
  expect(run.all).toBe(true);
  await expect(result.getByText(run.summary.digest)).toBeVisible();
  for (const format of ["CSV", "PARQUET", "NPZ", "MAT"]) {
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      result.getByRole("link", { name: format }).click(),
    ]);
    expect(download.suggestedFilename()).toBe(`ch5-seven-step.${format.toLowerCase()}`);
  }
  const script = await page.request.get(`${server.origin}/api/v1/runs/${id}/script`);
  expect(await script.text()).toContain(run.summary.digest);
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
});

test("a campaign is started, watched, cancelled, gone on with, and read", async ({ page, server }) => {
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?page=runs`);
  await page.getByText("Campaign", { exact: true }).click();
  await page.getByRole("combobox", { name: "Every combination of 1: path" }).fill("sensor.noise_um");
  await page.getByRole("textbox", { name: "sensor.noise_um: value" }).fill("0.05, 0.2");
  await page.getByRole("textbox", { name: "Seeds", exact: true }).fill("2000");
  await page.getByRole("button", { name: "Start 4000 runs" }).click();
  await page.getByRole("button", { name: "Cancel Campaign ch5-seven-step" }).click({ timeout: 120_000 });
  const jobs = page.getByRole("region", { name: "Runs and campaigns" });
  await expect(jobs.getByRole("listitem").getByText("cancelled")).toBeVisible({ timeout: 120_000 });

  await page.getByRole("textbox", { name: "Seeds", exact: true }).fill("3");
  await page.getByRole("button", { name: "Start 6 runs" }).click();
  const result = page.getByRole("region", { name: "Result" });
  await expect(result.getByText("6 of 6 runs · done")).toBeVisible({ timeout: 120_000 });
  const rows = result.getByRole("table").first().locator("tbody tr");
  await expect(rows).toHaveCount(2);
  await expect(rows.first()).toContainText("0.05");
  await result.getByRole("button", { name: "noise, µm" }).click();
  await result.getByRole("button", { name: "noise, µm" }).click();
  await expect(rows.first()).toContainText("0.2");
  await expect(result.getByRole("img", { name: /Receiver operating characteristic/ })).toBeVisible();
  await expect(result.getByRole("img", { name: /Detection delay/ })).toBeVisible();
  await expect(result.getByRole("table").filter({ hasText: "truth down" })).toBeVisible();
  const report = await page.request.get(await addressOf(result.getByRole("link", { name: "Report" })));
  expect(await report.text()).toContain("Receiver operating characteristic");
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
});

test("a campaign tells what its runs warn of, in the words of a run", async ({ page, server }) => {
  const scenario = "ch3-stvsc-mass";
  const set = { duration_ms: 3, "controller.layer_um": 1e-4 };
  const sweep = { schema: 1, id: "thin", scenario, set, seeds: "1:3" };
  const campaign = await server.ask<{ id: string }>("POST", "/sweeps", { sweep });
  const run = await server.ask<{ id: string }>("POST", "/runs", { scenario, set, seed: 2 });
  await page.request.get(server.url);
  for (const place of [`sweep=${campaign.id}`, `run=${run.id}`]) {
    await page.goto(`${server.origin}/?page=runs&${place}`);
    const warning = page.getByRole("region", { name: "Result" }).getByText(/^Warning: stvsc: the boundary layer/);
    await expect(warning).toBeVisible({ timeout: 120_000 });
  }
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
});

test("a value that is not allowed is refused, two that do not go together are a row with its error", async ({
  page,
  server,
}) => {
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?page=runs`);
  await page.getByText("Campaign", { exact: true }).click();
  await page.getByRole("combobox", { name: "Every combination of 1: path" }).fill("sensor.noise_um");
  const value = page.getByRole("textbox", { name: "sensor.noise_um: value" });
  await value.fill("0.01:0.2:299, -1");
  await page.getByRole("button", { name: "Start 300 runs" }).click();
  await expect(page.getByRole("form").getByRole("alert")).toContainText("sensor.noise_um");

  const grid = { "drive.kind": ["held", "analogue"], "controller.kind": ["open_loop", "mrac"] };
  const sweep = { schema: 1, id: "pairs", scenario: "first-look", set: { samples: 20 }, grid };
  const { id } = await server.ask<{ id: string }>("POST", "/sweeps", { sweep });
  await page.goto(`${server.origin}/?page=runs&sweep=${id}`);
  const result = page.getByRole("region", { name: "Result" });
  await expect(result.getByText("4 of 4 runs · done")).toBeVisible({ timeout: 120_000 });
  await expect(result.getByText(/^drive\.kind: analogue is for open_loop only/)).toBeVisible();
  await expect(result.getByRole("table").first().locator("tbody tr")).toHaveCount(4);
});

test("runs are named, found, compared and removed", async ({ page, server }) => {
  const wait = async (seed: number, label: string) => {
    const body = { scenario: "ch5-seven-step", set: { samples: 800 }, seed, label };
    const { id } = await server.ask<{ id: string }>("POST", "/runs", body);
    const state = () => server.ask<{ state: string }>("GET", `/runs/${id}`).then((found) => found.state);
    await expect.poll(state, { timeout: 120_000 }).toBe("done");
    return id;
  };
  const first = await wait(71, "quiet bench");
  const second = await wait(72, "quiet bench again");
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?page=runs&run=${first}`);
  const jobs = page.getByRole("region", { name: "Runs and campaigns" });
  const result = page.getByRole("region", { name: "Result" });

  const name = result.getByRole("textbox", { name: "Name" });
  await name.fill("loud bench");
  await name.press("Enter");
  await expect(result.getByRole("heading", { name: "loud bench" })).toBeVisible();

  await jobs.getByRole("searchbox").fill("bench");
  await expect(jobs.getByRole("listitem")).toHaveCount(2);
  await jobs.getByRole("searchbox").fill("no such run");
  await jobs.getByRole("button", { name: "Show all" }).click();
  await jobs.getByRole("combobox", { name: "Scenario of the runs" }).selectOption("ch5-seven-step");
  await jobs.getByRole("combobox", { name: "State" }).selectOption("done");
  await jobs.getByRole("searchbox").fill("bench");
  await expect(jobs.getByRole("listitem")).toHaveCount(2);

  for (const box of await jobs.getByRole("checkbox").all()) await box.check();
  await jobs.getByRole("button", { name: "Compare 2" }).click();
  await expect(page).toHaveURL(/[?&]compare=/);
  const row = result.getByRole("row", { name: /^rms error, nm/ });
  const { figures } = await server.ask<{ figures: { metric: string; differences: number[] }[] }>(
    "GET",
    `/runs/compare?ids=${second}&ids=${first}`,
  );
  const difference = figures.find(({ metric }) => metric === "control.rms_error_um")?.differences[1] ?? 0;
  expect(difference).not.toBe(0);
  await expect(row.getByRole("cell").last()).toHaveText(difference > 0 ? /^\+/ : /^−/);
  await expect(result.getByRole("img", { name: /^plant.displacement: displacement, µm/ })).toBeVisible();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));

  page.once("dialog", (dialog) => dialog.dismiss());
  await jobs.getByRole("button", { name: "Remove 2" }).click();
  await expect(jobs.getByRole("listitem")).toHaveCount(2);
  page.once("dialog", (dialog) => dialog.accept());
  await jobs.getByRole("button", { name: "Remove 2" }).click();
  await expect(jobs.getByText("No run matches")).toBeVisible();
  await expect(server.ask("GET", `/runs/${first}`)).rejects.toThrow("not_found");
});
