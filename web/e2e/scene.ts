import type { FrameLocator, Page } from "@playwright/test";
import { expect } from "./lab";

/** The view of the device in 3D. */
export const sceneOf = (page: Page | FrameLocator) => page.locator("iframe[title='The device in 3D']");

/** What it shows, as text that can be compared; the buttons over it are not drawn to the bit. */
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
