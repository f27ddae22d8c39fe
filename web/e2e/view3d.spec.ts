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

test.describe("in the hand", () => {
  test.use({ viewport: { width: 390, height: 844 }, colorScheme: "dark" });

  test("every camera keeps the device in the picture, and the scheme reaches it", async ({ page, openBench }) => {
    await openBench();
    await page.getByRole("button", { name: "Stop" }).click();
    const cameras = page.getByRole("group", { name: "Camera" });
    await cameras.evaluate((group) => group.parentElement?.scrollIntoView());
    const frame = page.locator("iframe[title='The device in 3D']");
    const inside = frame.contentFrame();
    await expect(inside.locator("#caption")).toContainText("motion ×", { timeout: 60_000 });
    const picture = async () => (await frame.screenshot()).toString("base64");
    const seen = new Set<string>();
    for (const name of ["Top", "Side", "Whole"]) {
      await cameras.getByRole("button", { name, exact: true }).click();
      await expect.poll(async () => seen.has(await picture()), { timeout: 20_000 }).toBe(false);
      let shown = "";
      const steady = async () => {
        const before = shown;
        shown = await picture();
        return shown === before;
      };
      await expect.poll(steady, { timeout: 20_000, intervals: [700] }).toBe(true);
      seen.add(shown);
      expect(await page.evaluate(edges, shown), `${name} is cut off`).toEqual({ left: true, right: true, drawn: true });
    }
    await inside.locator("body").evaluate((body) => body.setAttribute("data-kept", "yes"));
    await page.keyboard.press("d");
    await expect(inside.locator("html")).toHaveAttribute("data-scheme", "light");
    await expect(inside.locator("body")).toHaveAttribute("data-kept", "yes");
  });
});

/** Whether both edges of a picture are empty, between the buttons and the caption, and its middle is not. */
async function edges(png: string): Promise<{ left: boolean; right: boolean; drawn: boolean }> {
  const bytes = Uint8Array.from(atob(png), (letter) => letter.charCodeAt(0));
  const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
  const context = new OffscreenCanvas(image.width, image.height).getContext("2d") as OffscreenCanvasRenderingContext2D;
  context.drawImage(image, 0, 0);
  const rows = [44, image.height - 60 - 44] as const;
  const empty = (x: number, width: number) => {
    const { data } = context.getImageData(x, rows[0], width, rows[1]);
    return data.every((value, k) => Math.abs(value - data[k % 4]) < 6);
  };
  return { left: empty(0, 2), right: empty(image.width - 2, 2), drawn: !empty(image.width / 2, 8) };
}
