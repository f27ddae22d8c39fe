import type { CDPSession, Page } from "@playwright/test";
import { expect } from "./lab";
import { faultsInBothSchemes } from "./layout-faults";
import { faintLetters } from "./serious-violations";

export interface Screen {
  width: number;
  height: number;
}

/** The screens the page is made for: a projector, a large one, a tablet and a phone. */
export const SCREENS: Screen[] = [
  { width: 1366, height: 768 },
  { width: 1920, height: 1080 },
  { width: 820, height: 1180 },
  { width: 390, height: 844 },
];

export const SCHEMES = ["dark", "light"] as const;

export const isPhone = ({ width }: Screen): boolean => width < 600;

export const nameOf = ({ width, height }: Screen): string => `${width} x ${height}`;

const sessions = new WeakMap<Page, CDPSession>();

/** Show a page on a screen, without loading it again; small screens are touched. */
export async function showOn(page: Page, { width, height }: Screen): Promise<void> {
  // an emulation ends with its session
  const session = sessions.get(page) ?? (await page.context().newCDPSession(page));
  sessions.set(page, session);
  await session.send("Emulation.setTouchEmulationEnabled", { enabled: width < 1000 });
  await page.setViewportSize({ width, height });
  await expect.poll(() => dockFollows(page)).toBe(true); // a layout chosen earlier would fit the screen before
}

/** Whether the panels, if any, are as wide as their place. */
const dockFollows = (page: Page): Promise<boolean> =>
  page.evaluate(() => {
    const dock = document.querySelector<HTMLElement>(".dockview-theme-combbench");
    const root = dock?.querySelector<HTMLElement>(".dv-grid-view, .dv-split-view-container");
    return !dock || !root || Math.abs(dock.clientWidth - root.clientWidth) < 2;
  });

/** Nothing overlaps or is cut in either scheme; an element that appears or disappears may do so for a moment. */
export async function expectClean(page: Page, where: string, within?: string): Promise<void> {
  await expect.soft.poll(() => faultsInBothSchemes(page, within), where).toEqual([]);
}

/** Whatever is written can be read in a scheme. */
export async function expectReadable(
  page: Page,
  where: string,
  colorScheme: "dark" | "light",
  within?: string,
): Promise<void> {
  await page.emulateMedia({ colorScheme });
  expect.soft(await faintLetters(page, within), `${where}, ${colorScheme}`).toEqual([]);
}

/** The views that a phone opens below its scope. */
export async function viewsOnPhone(page: Page): Promise<string[]> {
  await page.getByRole("button", { name: "More", exact: true }).click();
  await expect(page.getByRole("dialog", { name: "Panels" })).toBeVisible();
  const views = await page
    .locator("[data-view]")
    .evaluateAll((all) => all.map((one) => (one as HTMLElement).dataset.view));
  await page.keyboard.press("Escape");
  await expect(page.getByRole("dialog", { name: "Panels" })).toHaveCount(0);
  return views as string[];
}

/** Open a view below the scope of a phone. */
export async function openOnPhone(page: Page, view: string): Promise<void> {
  await page.getByRole("button", { name: "More", exact: true }).click();
  await page.locator(`[data-view="${view}"]`).click();
  await expect(page.getByRole("dialog", { name: "Panels" })).toHaveCount(0);
}

/** A page, or a part of it, fits on every screen and can be read; a phone shows a panel when it is chosen. */
export async function expectFits(page: Page, what: string, within?: string, panel?: string): Promise<void> {
  const before = page.viewportSize() ?? SCREENS[0];
  for (const screen of SCREENS) {
    await showOn(page, screen);
    if (panel && isPhone(screen)) await openOnPhone(page, panel);
    await expectClean(page, `${what} at ${nameOf(screen)}`, within);
  }
  await showOn(page, before);
  for (const scheme of SCHEMES) await expectReadable(page, what, scheme, within);
}
