import { expect, test } from "./lab";

test("an injected fault is found, the delay is printed, and healing clears it", async ({ page, openBench }) => {
  await openBench();
  const lanes = page.getByRole("region", { name: "Diagnosis by kalman" });
  await expect(lanes.getByText("healthy", { exact: true })).toBeVisible();
  await page.getByRole("button", { name: /^Inject \+5.*Added mass$/ }).click();
  await expect(page.getByText("1 fault acts")).toBeVisible();
  await expect(lanes.getByText("m+5", { exact: true })).toBeVisible();
  await expect(lanes.getByText(/^\d+\ssamples · [1-9]\d{0,2}(\.\d+)?\s(µs|ms)$/)).toBeVisible();

  await page.getByRole("tab", { name: "Events" }).click();
  await expect(page.getByRole("button", { name: /kalman found m\+5 after \d+\ssamples/ })).toBeVisible();
  await page.getByRole("button", { name: /inject added_mass/ }).click();
  await expect(page.getByRole("button", { name: "LIVE" }).first()).toHaveAttribute("aria-pressed", "false");
  await page.keyboard.press("l");
  await expect(page.getByRole("button", { name: "LIVE" }).first()).toHaveAttribute("aria-pressed", "true");

  await page.getByRole("button", { name: "Heal all" }).click();
  await expect(page.getByText("The device is healthy")).toBeVisible();
});

test("a fault can be set exactly and wait for its moment", async ({ page, openBench }) => {
  await openBench();
  await page.getByRole("button", { name: "Damping", exact: true }).click();
  await page.getByRole("textbox", { name: "Severity of Damping, exact" }).fill("55");
  await page.getByText("on a condition").click();
  await page.getByRole("textbox", { name: "When" }).fill("plant.displacement > 500");
  await page.getByRole("button", { name: /Let it wait/ }).click();
  await expect(page.getByText(/^Waiting: inject damping \+0\.55/)).toBeVisible();

  await page.getByRole("textbox", { name: "When" }).fill("nonsense > 2");
  await page.getByRole("button", { name: /Let it wait/ }).click();
  await expect(page.getByRole("alert").filter({ hasText: /nonsense/ })).toBeVisible();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
});
