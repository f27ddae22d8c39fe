import { expect, test } from "./lab";

test("the device is alive in 3D", async ({ page, openBench }) => {
  await openBench("research");
  const canvas = page.frameLocator("iframe[title='The device in 3D']").locator("canvas");
  await expect(canvas.first()).toBeVisible({ timeout: 60_000 });
  await expect(page.getByText("The 3D view waits for the server")).toBeHidden();
  await expect(page.getByTestId("bench-state")).toHaveText("running", { timeout: 30_000 });
});
