import { expect, test } from "./lab";

test.use({ viewport: { width: 390, height: 844 } });

test("a phone shows status, scope and lanes, and stops the bench", async ({ page, openBench }) => {
  await openBench();
  await expect(page.getByRole("region", { name: /^Scope/ })).toBeVisible();
  await expect(page.getByRole("region", { name: "Diagnosis by kalman" })).toBeVisible();
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  expect(overflow).toBeLessThanOrEqual(0);
  await page.getByRole("button", { name: "Stop" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await page.getByRole("button", { name: "Run", exact: true }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
});
