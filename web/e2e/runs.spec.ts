import { addressOf, expect, test } from "./lab";

test("a run is started from the page and its files are offered; a campaign is started, cancelled, started anew and read", async ({
  page,
  server,
}) => {
  await page.request.get(server.url);
  await page.goto(`${server.origin}/runs`);
  const form = page.getByRole("form", { name: "Start" });
  const result = page.getByRole("region", { name: "Result" });
  await form.getByRole("button", { name: "Change a value" }).click();
  await form.getByRole("combobox", { name: "With other values 1: path" }).fill("sensor.noise");
  await page.getByRole("option", { name: "sensor.noise_um" }).click();
  const value = form.getByRole("textbox", { name: "sensor.noise_um: value" });
  const run = form.getByRole("button", { name: "Run", exact: true });
  await value.fill("-1");
  await run.click();
  await expect(form.getByRole("alert")).toContainText("sensor.noise_um");
  await value.fill("0.06");
  await form.getByRole("checkbox", { name: "Keep all signals" }).check();
  await run.click();
  await expect(page).toHaveURL(/\/runs\/\w+\?/);
  const id = new URL(page.url()).pathname.split("/").at(-1);
  await expect(result.getByText("Expectations")).toBeVisible();
  const asked = () => server.ask<{ state: string; all: boolean; summary: { digest: string } }>("GET", `/runs/${id}`);
  await expect.poll(async () => (await asked()).state).toBe("done");
  const { all, summary } = await asked();
  expect(all).toBe(true);
  await expect(result.getByText(summary.digest)).toBeVisible();
  for (const format of ["CSV", "MAT"]) {
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      result.getByRole("link", { name: format }).click(),
    ]);
    expect(download.suggestedFilename()).toBe(`ch5-seven-step.${format.toLowerCase()}`);
  }
  const script = await page.request.get(`${server.origin}/api/v1/runs/${id}/script`);
  expect(await script.text()).toContain(summary.digest);

  await page.goto(`${server.origin}/runs`);
  await page.getByText("Campaign", { exact: true }).click();
  await form.getByRole("combobox", { name: "Grid over 1: path" }).fill("sensor.noise_um");
  await value.fill("0.05, 0.2");
  const seeds = form.getByRole("textbox", { name: "Seeds", exact: true });
  await seeds.fill("2000");
  await form.getByRole("button", { name: "Start 4000 runs" }).click();
  const jobs = page.getByRole("region", { name: "Runs and campaigns" });
  await jobs.getByRole("button", { name: "Cancel Campaign ch5-seven-step" }).click();
  await expect(jobs.getByRole("listitem").getByText("cancelled")).toBeVisible();
  await seeds.fill("2");
  await form.getByRole("button", { name: "Start 4 runs" }).click();
  await expect(result.getByText("4 of 4 runs · done")).toBeVisible();
  await result.getByText("All points as a table").click();
  const rows = result.locator("details").getByRole("table").locator("tbody tr");
  await expect(rows).toHaveCount(2);
  await expect(rows.first()).toContainText("0.05");
  await result.getByRole("button", { name: "noise, µm" }).dblclick();
  await expect(rows.first()).toContainText("0.2");
  await expect(result.getByRole("img", { name: /Receiver operating characteristic/ })).toBeVisible();
  await expect(result.getByRole("img", { name: /Detection delay/ })).toBeVisible();
  await expect(result.getByRole("table").filter({ hasText: "truth down" })).toBeVisible();
  const report = await page.request.get(await addressOf(result.getByRole("link", { name: "Report" })));
  expect(await report.text()).toContain("Receiver operating characteristic");
});
