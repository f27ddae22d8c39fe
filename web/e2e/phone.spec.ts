import { expect, test } from "./lab";

test.use({ viewport: { width: 390, height: 844 }, hasTouch: true });

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

test("whatever a finger taps is 24 px or more", async ({ page, openBench }) => {
  await openBench();
  await page.getByRole("combobox", { name: "Another panel" }).selectOption("labs");
  await expect(page.getByRole("slider").first()).toBeVisible();
  const small = await page.locator("button, [role=slider]").evaluateAll((targets) =>
    targets
      .map((target) => ({
        name: target.getAttribute("aria-label") ?? target.textContent,
        box: target.getBoundingClientRect(),
      }))
      .filter(({ box }) => box.width > 0 && Math.min(box.width, box.height) < 24)
      .map(({ name }) => name),
  );
  expect(small).toEqual([]);
});
