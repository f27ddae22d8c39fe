import { benchOf, expect, join, PHONE, test } from "./classroom";

test.use({ viewport: PHONE, hasTouch: true });

test("a student on a phone sees status, scope and lanes, injects a fault and stops the bench", async ({
  page,
  server,
  group,
}) => {
  await join(page, server, group.code, "Ada");
  await expect(page.getByRole("region", { name: /^Scope/ })).toBeVisible();
  const lanes = page.getByRole("region", { name: "Diagnosis by kalman" });
  await expect(lanes).toBeVisible();
  await page.getByRole("button", { name: "Stop" }).tap();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await page.getByRole("button", { name: "Run", exact: true }).tap();
  await expect(page.getByTestId("bench-state")).toHaveText("running");

  const panel = page.getByRole("combobox", { name: "Another panel" });
  await panel.selectOption("faults");
  await page.getByRole("button", { name: /^Inject \+5.*Added mass$/ }).tap();
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  await server.advanceTicks(benchOf(page), 1500);
  await expect(lanes.getByText(/^mass \+5/).first()).toBeVisible();

  await panel.selectOption("labs");
  await expect(page.getByRole("slider").first()).toBeVisible();
  const small = await page.locator("button, [role=slider]").evaluateAll((targets) =>
    targets
      .filter((target) => {
        const { width, height } = target.getBoundingClientRect();
        return width > 0 && Math.min(width, height) < 24;
      })
      .map((target) => target.getAttribute("aria-label") ?? target.textContent),
  );
  expect(small, "targets too small for a finger").toEqual([]);
  expect(await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth)).toBeLessThanOrEqual(0);
});
