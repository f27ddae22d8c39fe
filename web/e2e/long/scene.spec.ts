import { expect, test } from "../lab";
import { sceneAtRest, sceneOf, scenePicture, sceneShown, WEBGL_BROWSER } from "../scene";
import { openOnPhone } from "../screens";

test.use({ drawn: true, ...WEBGL_BROWSER, viewport: { width: 390, height: 844 }, colorScheme: "dark" });

test("every camera keeps the device in the picture, and the scheme reaches it", async ({ page, server, openBench }) => {
  await openBench();
  await server.advance(1);
  await page.getByRole("button", { name: "Stop" }).click();
  await openOnPhone(page, "view3d");
  const cameras = page.getByRole("group", { name: "Camera" });
  const frame = sceneOf(page);
  const inside = frame.contentFrame();
  await expect(inside.locator("#caption")).toContainText("motion ×");
  const seen = new Set<string>();
  for (const name of ["Top", "Side", "Whole"]) {
    await cameras.getByRole("button", { name, exact: true }).click();
    await expect.poll(async () => seen.has(await sceneShown(page))).toBe(false);
    seen.add(await sceneAtRest(page));
    const picture = (await scenePicture(page)).toString("base64");
    expect(await page.evaluate(edges, picture), `${name} is cut off`).toEqual({ left: true, right: true, drawn: true });
  }
  await inside.locator("body").evaluate((body) => body.setAttribute("data-kept", "yes"));
  await page.keyboard.press("d");
  await expect(inside.locator("html")).toHaveAttribute("data-scheme", "light");
  await expect(inside.locator("body")).toHaveAttribute("data-kept", "yes");
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
