import type { Page } from "@playwright/test";
import { expect } from "./lab";

/** The view of the device in 3D. */
export const sceneOf = (page: Pick<Page, "locator">) => page.locator("iframe[title='The device in 3D']");

/** The picture of it, as text that can be compared; the buttons over it are not drawn to the bit. */
export const sceneShown = async (page: Page): Promise<string> =>
  (await sceneOf(page).screenshot({ mask: [page.getByRole("group", { name: "Camera" })] })).toString("base64");

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
