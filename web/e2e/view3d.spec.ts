import { expect, test } from "./lab";

test("the device is alive in 3D: it is drawn, and it moves", async ({ page, openBench }) => {
  await openBench("research");
  const canvas = page.frameLocator("iframe[title='The device in 3D']").locator("canvas").first();
  await expect(canvas).toBeVisible({ timeout: 60_000 });
  await expect(page.getByText("The 3D view waits for the server")).toBeHidden();
  const picture = async () => (await canvas.screenshot()).toString("base64");
  const before = await picture();
  await expect.poll(picture, { timeout: 60_000, intervals: [500] }).not.toBe(before);
  await expect(page.getByTestId("bench-state")).toHaveText("running", { timeout: 30_000 });
});
