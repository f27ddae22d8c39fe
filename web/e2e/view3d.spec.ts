import { expect, test } from "./lab";
import { sceneAtRest, sceneOf, sceneShown } from "./scene";

test.use({ drawn: true });

test("the device is alive in 3D: it is drawn, and it moves", async ({ page, openBench }) => {
  await openBench("research");
  const canvas = sceneOf(page).contentFrame().locator("canvas").first();
  await expect(canvas).toBeVisible({ timeout: 120_000 });
  await expect(page.getByText("The 3D view waits for the server")).toBeHidden();
  const picture = async () => (await canvas.screenshot()).toString("base64");
  const before = await picture();
  await expect.poll(picture, { timeout: 120_000, intervals: [500] }).not.toBe(before);
  await expect(page.getByTestId("bench-state")).toHaveText("running", { timeout: 120_000 });
});

test("scene and camera outlive layouts, a maximised panel, a closed panel, other pages", async ({
  page,
  openBench,
}) => {
  const warnings: string[] = [];
  page.on("console", (message) => message.type() === "warning" && warnings.push(message.text()));
  await openBench("research");
  await page.getByRole("button", { name: "Pause" }).click();
  const frame = sceneOf(page);
  const inside = frame.contentFrame();
  await expect(inside.locator("#caption")).toContainText("motion ×", { timeout: 120_000 });
  await inside.locator("body").evaluate((body) => body.setAttribute("data-kept", "yes"));
  await page.evaluate(() =>
    window.addEventListener("message", ({ data }) => data.look && Object.assign(window, { looked: data.look })),
  );
  // somebody turns the device
  const whole = await sceneAtRest(page);
  const box = (await frame.boundingBox()) as { x: number; y: number; width: number; height: number };
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 90, box.y + box.height / 2 + 30, { steps: 5 });
  await page.mouse.up();
  await expect.poll(() => sceneShown(page), { timeout: 120_000 }).not.toBe(whole);
  await sceneAtRest(page);
  const camera = () => page.evaluate(() => (window as { looked?: { position: number[] } }).looked?.position);
  const turned = await camera();
  expect(turned).toHaveLength(3);
  const kept = async () => {
    await expect(inside.locator("body")).toHaveAttribute("data-kept", "yes");
    (await camera())?.forEach((value, axis) => {
      expect(value).toBeCloseTo((turned as number[])[axis], 3);
    });
  };

  await page.keyboard.press("2"); // the lab layout has no 3D
  await expect(frame).toBeHidden();
  await page.keyboard.press("1");
  await expect(frame).toBeVisible();
  await kept();
  const group = page.locator(".dv-groupview", { has: page.getByRole("tab", { name: "3D" }) });
  await group.getByRole("button", { name: "Fill the page with this panel" }).click();
  await expect.poll(async () => (await frame.boundingBox())?.width).toBeGreaterThan(box.width * 2);
  await kept();
  await group.getByRole("button", { name: "Back to all panels" }).click();
  await group.getByRole("button", { name: "Add or close panels" }).click();
  await page.getByRole("menuitem", { name: "Close 3D" }).click();
  await expect(frame).toBeHidden();
  await page.keyboard.press("g");
  await page.keyboard.press("g");
  await page.keyboard.press("3");
  await expect(frame).toBeVisible();
  await kept();

  // its connection breaks: it loads again, and looks from where it was put
  await page.evaluate(() => Object.assign(window, { looked: undefined }));
  await inside.locator("body").evaluate(() => parent.postMessage({ viser: "closed" }, location.origin));
  await expect(inside.locator("body")).not.toHaveAttribute("data-kept");
  await expect
    .poll(async () => (await camera())?.map((value) => value.toFixed(2)), { timeout: 120_000 })
    .toEqual(turned?.map((value) => value.toFixed(2)));
  expect(warnings.filter((text) => text.includes("THREE."))).toEqual([]);
});

test.describe("in the hand", () => {
  test.use({ viewport: { width: 390, height: 844 }, colorScheme: "dark" });

  test("every camera keeps the device in the picture, and the scheme reaches it", async ({ page, openBench }) => {
    await openBench();
    await page.getByRole("button", { name: "Stop" }).click();
    const cameras = page.getByRole("group", { name: "Camera" });
    await cameras.evaluate((group) => group.parentElement?.scrollIntoView());
    const frame = sceneOf(page);
    const inside = frame.contentFrame();
    await expect(inside.locator("#caption")).toContainText("motion ×", { timeout: 120_000 });
    const seen = new Set<string>();
    for (const name of ["Top", "Side", "Whole"]) {
      await cameras.getByRole("button", { name, exact: true }).click();
      await expect.poll(async () => seen.has(await sceneShown(page)), { timeout: 120_000 }).toBe(false);
      const shown = await sceneAtRest(page);
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
