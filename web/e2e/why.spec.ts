import { expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("a click on a sample shows the numbers behind it, and the next sample is one key away", async ({
  page,
  openBench,
}) => {
  await openBench("research");
  const lanes = page.getByRole("region", { name: "Diagnosis by kalman" });
  await expect(lanes.getByText("healthy", { exact: true })).toBeVisible();
  await page.waitForTimeout(2000); // some samples to click on
  const canvas = lanes.locator("canvas");
  const box = await canvas.boundingBox();
  if (!box) throw new Error("the lanes are not drawn");
  await page.mouse.click(box.x + box.width * 0.75, box.y + 20);

  const why = page.getByRole("region", { name: "Why this sample" });
  await expect(why.getByRole("row")).toHaveCount(7);
  const healthy = why.getByRole("row", { name: /^healthy/ });
  await expect(healthy).toContainText("%");
  // the equations carry the numbers: a density, Bayes' rule, the floor
  await expect(why.getByRole("listitem")).toHaveCount(3);
  await why.getByRole("button", { name: "m+5" }).click();
  await expect(why.getByRole("heading", { name: /^m\+5 at this sample/ })).toBeVisible();

  const tick = Number(await why.getByRole("textbox", { name: "Sample" }).inputValue());
  await why.getByRole("button", { name: "Sample after" }).press("Enter");
  await expect(why.getByRole("textbox", { name: "Sample" })).toHaveValue(String(tick + 1));
  await seriousViolations(page).then((found) => expect(found).toEqual([]));

  await why.getByRole("textbox", { name: "Sample" }).fill("999999999");
  await why.getByRole("textbox", { name: "Sample" }).press("Enter");
  await expect(why.getByText(/^Sample 999999999 is not kept; the history has/)).toBeVisible();
  await why.getByRole("button", { name: "Explain the latest sample" }).click();
  await expect(healthy).toBeVisible();
});
