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
  await expect.poll(() => sizesOf(page)).toEqual(before);
});
