import { createHash } from "node:crypto";
import type { Page } from "@playwright/test";
import { expect } from "./lab";

/** The view of the device in 3D. */
export const sceneOf = (page: Pick<Page, "locator">) => page.locator("iframe[title='The device in 3D']");

/** The bytes of its picture; the buttons over it are not drawn to the bit. */
export const scenePicture = (page: Page): Promise<Buffer> =>
  sceneOf(page).screenshot({ mask: [page.getByRole("group", { name: "Camera" })] });

/** The picture as a short text that can be compared. */
export const sceneShown = async (page: Page): Promise<string> =>
  createHash("sha256")
    .update(await scenePicture(page))
    .digest("hex");

/** The same, once two pictures in a row are alike. */
export async function sceneAtRest(page: Page): Promise<string> {
  let shown = "";
  const rests = async () => {
    const before = shown;
    shown = await sceneShown(page);
    return shown === before;
  };
  await expect.poll(rests).toBe(true);
  return shown;
}

/** A browser that draws WebGL by software. */
export const WEBGL_BROWSER = {
  launchOptions: {
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: [
      "--no-sandbox",
      "--disable-gpu",
      "--use-gl=angle",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      "--ignore-gpu-blocklist",
    ],
  },
};
