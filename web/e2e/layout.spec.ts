import type { Page } from "@playwright/test";
import { expect, test } from "./lab";

const sizesOf = (page: Page) =>
  page.locator(".dv-groupview").evaluateAll((groups) => groups.map((g) => [g.clientWidth, g.clientHeight]));

test("panels keep their sizes, and the open tab is in view, when the page is opened again", async ({
  page,
  openBench,
}) => {
  await openBench("lab");
  const labs = page.getByRole("tab", { name: "Noise and memory" });
  await labs.click();
  const notice = page.getByRole("region", { name: "Notice" }); // takes room of its own
  await expect(notice).toBeVisible();
  const before = await sizesOf(page);
  for (let i = 0; i < 2; i += 1) {
    await page.reload();
    await expect(labs).toBeInViewport({ ratio: 1 });
    await expect(notice).toBeVisible();
    await page.getByRole("tab", { name: i ? "Diagnosis" : "Events", exact: true }).click(); // stores the layout again
  }
  expect(await sizesOf(page)).toEqual(before);
});

test("panels are arranged anew when the window crosses a breakpoint, unless somebody has moved them", async ({
  page,
  openBench,
}) => {
  await openBench("research");
  const beside = page.locator(".dv-groupview", { has: page.getByRole("tab", { name: "Bench", exact: true }) });
  const behind = beside.getByRole("tab", { name: "3D" });
  await expect(behind).toHaveCount(0);
  await page.setViewportSize({ width: 820, height: 1180 });
  await expect(behind).toHaveCount(1);
  await page.setViewportSize({ width: 1440, height: 900 });
  await expect(behind).toHaveCount(0);

  await page.getByRole("tab", { name: "Voltage" }).focus();
  await page.keyboard.press("Delete");
  await expect
    .poll(() => page.evaluate(() => Object.keys(localStorage).filter((key) => key.endsWith(".madefor"))))
    .toEqual([]);
  const panels = await page.getByRole("tab").count();
  await page.setViewportSize({ width: 820, height: 1180 });
  await page.waitForTimeout(600); // nothing is to happen, which no condition can tell
  await expect(behind).toHaveCount(0);
  expect(await page.getByRole("tab").count()).toBe(panels);
});
