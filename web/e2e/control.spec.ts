import { readFile } from "node:fs/promises";
import { expect, test } from "./lab";

test("the controller changes live", async ({ page, openBench }) => {
  await openBench();
  await page.getByRole("combobox", { name: "Controller" }).click();
  await page.getByRole("option", { name: /^Direct MRAC Direct model/ }).click();
  await page.getByRole("tab", { name: "Events" }).click();
  await expect(page.getByRole("button", { name: /^\d.*switch to mrac/ })).toBeVisible();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
});

test("keys act after Escape from a list or a field", async ({ page, openBench }) => {
  await openBench();
  await page.getByRole("combobox", { name: "Controller" }).first().click();
  await expect(page.getByRole("option", { name: /^PID/ })).toBeVisible();
  await page.keyboard.press("Escape");
  await expect(page.getByRole("option", { name: /^PID/ })).toBeHidden();
  await page.keyboard.press("t");
  await expect(page.getByRole("heading", { name: "Theory" })).toBeVisible();
  await page.getByRole("textbox", { name: "Search equations" }).fill("t");
  await page.keyboard.press("Escape");
  await page.keyboard.press("b");
  await expect(page.getByRole("region", { name: /^Scope/ }).first()).toBeVisible();
});

test("keys act after a choice, and a bench that stands still shows its traces in the other scheme too", async ({
  page,
  openBench,
}) => {
  await openBench();
  const scope = page.getByRole("region", { name: /^Scope: reference.voltage/ });
  await expect(scope.getByText(/\d\sV$/).first()).toBeVisible();
  await page.getByRole("combobox", { name: "Controller" }).click();
  await page.getByRole("option", { name: /^PID / }).click();
  await page.keyboard.press("Space");
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  const scheme = () => page.evaluate(() => document.documentElement.dataset.mantineColorScheme);
  const before = await scheme();
  await page.keyboard.press("d");
  await expect.poll(scheme).not.toBe(before);
  await page.waitForTimeout(500); // a picture that is to come would be there
  await expect(scope.getByText(/\d\sV$/)).toHaveCount(2);
});

test("a parameter changes live, a wrong one is refused in words, and what happened is saved", async ({
  page,
  openBench,
}) => {
  await openBench();
  await page.getByRole("button", { name: /Sensor ?Ideal/ }).click();
  const noise = page.getByRole("textbox", { name: /^Noise, µm/ });
  await noise.fill("0.2");
  await noise.press("Enter");
  await page.getByRole("tab", { name: "Events" }).click();
  await expect(page.getByRole("button", { name: /^\d.*set sensors?\..*noise_um = 0\.2/ })).toBeVisible();
  await noise.fill("-1");
  await noise.press("Enter");
  await expect(page.getByRole("alert").filter({ hasText: "at least 0" })).toBeVisible();

  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name: /^Save what happened/ }).click(),
  ]);
  const toml = await readFile(await download.path(), "utf8");
  expect(toml).toMatch(/sensors?\..*noise_um/);
  expect(download.suggestedFilename()).toMatch(/^first-look-\d+\.toml$/);
});

test("a runaway controller trips the board, the page says why, and the trip can be reset", async ({
  page,
  openBench,
  server,
}) => {
  await openBench();
  const id = new URL(page.url()).searchParams.get("bench");
  const send = (data: object) => server.ask("POST", `/benches/${id}/commands`, data);
  await send({ switch: "mrac", cold: true });
  await send({ set: { "controllers.mrac.adaptation_gain": 30 } });
  await send({ kind: "time_scale", value: 0.1 });
  await expect(page.getByTestId("bench-state")).toHaveText("tripped", { timeout: 120_000 });
  await expect(page.getByText(/^Tripped: /)).toBeVisible();
  await expect(page.getByText("The voltage is off")).toBeVisible();
  await page.getByRole("button", { name: "Reset the trip" }).click();
  await expect(page.getByTestId("bench-state")).not.toHaveText("tripped");
});
