import { expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("assumed noise is turned away from the true one, and the residuals say so", async ({ page, openBench }) => {
  await openBench("lab");
  await page.getByRole("tab", { name: "Noise and memory" }).click();
  const panel = page.getByRole("region", { name: "Labs" });
  const residuals = panel
    .locator("div")
    .filter({ hasText: /^residuals against assumed/ })
    .locator("dd");
  const ratio = async () => Number.parseFloat((await residuals.textContent()) ?? "");
  // a mean of few samples, as on a machine that has just begun, may still be anywhere
  await expect.poll(async () => Math.abs(Math.log(await ratio()))).toBeLessThan(Math.log(1.4));
  const assumed = panel.getByRole("textbox", { name: "Assumed variance over true" });
  await assumed.fill("0.1");
  await assumed.press("Enter");
  await page.getByRole("button", { name: "Count afresh" }).click();
  // a tenth of the variance assumed: residuals ten times what they should be
  await expect.poll(ratio).toBeGreaterThan(4);
  await expect(panel.getByRole("button", { name: /^Assumed variance over true: back to 1/ })).toBeVisible();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
});
