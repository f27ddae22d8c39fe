import { expect, test } from "./lab";
import { sceneAtRest, sceneOf, scenePicture, sceneShown, WEBGL_BROWSER } from "./scene";

test.use({ drawn: true, ...WEBGL_BROWSER });

test("the device in 3D moves with the clock, shows a fault, and keeps its camera over layouts and other pages", async ({
  page,
  server,
  openBench,
}) => {
  const warnings: string[] = [];
  page.on("console", (message) => message.type() === "warning" && warnings.push(message.text()));
  await openBench("research");
  const frame = sceneOf(page);
  const inside = frame.contentFrame();
  await expect(inside.locator("#caption")).toContainText("reference");
  await server.advance(0.5);
  await expect(inside.locator("#caption")).toContainText("motion ×");
  await expect(page.getByText("The 3D view waits for the server")).toBeHidden();
  const first = await sceneAtRest(page);
  await server.advance(0.53); // not a whole number of periods
  await expect.poll(() => sceneShown(page)).not.toBe(first);

  const showsFault = async () => page.evaluate(hasRed, (await scenePicture(page)).toString("base64"));
  expect(await showsFault()).toBe(false);
  await page.getByRole("button", { name: /^Inject .* Added mass$/ }).click();
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  await server.advance(0.5);
  await expect.poll(showsFault).toBe(true);
  await page.getByRole("button", { name: "Heal all" }).click();
  await expect(page.getByText("The device is healthy")).toBeVisible();
  await server.advance(0.5);
  await expect.poll(showsFault).toBe(false);

  // the mouse turns the device
  await inside.locator("body").evaluate((body) => body.setAttribute("data-kept", "yes"));
  await page.evaluate(() =>
    window.addEventListener("message", ({ data }) => data.look && Object.assign(window, { looked: data.look })),
  );
  const camera = () =>
    page.evaluate(() =>
      (window as { looked?: { position: number[] } }).looked?.position.map((value) => value.toFixed(2)),
    );
  const whole = await sceneAtRest(page);
  const box = (await frame.boundingBox()) as { x: number; y: number; width: number; height: number };
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 90, box.y + box.height / 2 + 30, { steps: 5 });
  await page.mouse.up();
  await expect.poll(() => sceneShown(page)).not.toBe(whole);
  await sceneAtRest(page);
  const turned = await camera();
  expect(turned).toHaveLength(3);
  const expectKept = async () => {
    await expect(frame).toBeVisible();
    await expect(inside.locator("body")).toHaveAttribute("data-kept", "yes");
    await expect.poll(camera).toEqual(turned);
  };

  await page.keyboard.press("2"); // the lab layout has no 3D
  await expect(frame).toBeHidden();
  await page.keyboard.press("1");
  await expectKept();
  const group = page.locator(".dv-groupview", { has: page.getByRole("tab", { name: "3D" }) });
  await group.getByRole("button", { name: "Fill the page with this panel" }).click();
  await expect.poll(async () => (await frame.boundingBox())?.width).toBeGreaterThan(box.width * 2);
  await expectKept();
  await group.getByRole("button", { name: "Back to all panels" }).click();
  await group.getByRole("button", { name: "Add or close panels" }).click();
  await page.getByRole("menuitem", { name: "Close 3D" }).click();
  await expect(frame).toBeHidden();
  await page.keyboard.press("g");
  await page.keyboard.press("g");
  await page.keyboard.press("3");
  await expectKept();

  // its connection breaks: it loads again, and looks from the same place
  await page.evaluate(() => Object.assign(window, { looked: undefined }));
  await inside.locator("body").evaluate(() => parent.postMessage({ viser: "closed" }, location.origin));
  await expect(inside.locator("body")).not.toHaveAttribute("data-kept");
  await expect.poll(camera).toEqual(turned);
  expect(warnings.filter((text) => text.includes("THREE."))).toEqual([]);
});

/** Whether a picture has the red of a fault. */
async function hasRed(png: string): Promise<boolean> {
  const bytes = Uint8Array.from(atob(png), (letter) => letter.charCodeAt(0));
  const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
  const context = new OffscreenCanvas(image.width, image.height).getContext("2d") as OffscreenCanvasRenderingContext2D;
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, image.width, image.height);
  for (let at = 0; at < data.length; at += 4)
    if (data[at] > 180 && data[at + 1] < 110 && data[at + 2] < 110) return true;
  return false;
}
