import type { CDPSession, Page } from "@playwright/test";
import { expect } from "./lab";
import { layoutFaults } from "./layout-faults";
import { faintLetters } from "./serious-violations";

type Scheme = "light" | "dark";

export interface Screen {
  width: number;
  height: number;
  scheme: Scheme;
}

/** The screens the page is made for: a projector, a large one, a tablet and a phone. */
export const SCREENS: Screen[] = [
  { width: 1366, height: 768, scheme: "light" },
  { width: 1920, height: 1080, scheme: "dark" },
  { width: 820, height: 1180, scheme: "light" },
  { width: 390, height: 844, scheme: "dark" },
];

export const nameOf = ({ width, height }: Screen): string => `${width} x ${height}`;

const sessions = new WeakMap<Page, CDPSession>();

/** Show a page on a screen, without loading it again; what is small is touched. */
export async function showOn(page: Page, { width, height, scheme }: Screen): Promise<void> {
  // what a session emulates ends with it
  const session = sessions.get(page) ?? (await page.context().newCDPSession(page));
  sessions.set(page, session);
  await session.send("Emulation.setTouchEmulationEnabled", { enabled: width < 1000 });
  await page.emulateMedia({ colorScheme: scheme });
  await page.setViewportSize({ width, height });
}

/** Nothing overlaps or is cut; what comes or goes may do so for a moment. */
export async function expectClean(page: Page, where: string, within?: string): Promise<void> {
  await expect.soft.poll(() => layoutFaults(page, within), { message: where, timeout: 10_000 }).toEqual([]);
}

/** Whatever is written can be read in both schemes. */
export async function expectReadable(page: Page, where: string, within?: string): Promise<void> {
  for (const colorScheme of ["dark", "light"] as const) {
    await page.emulateMedia({ colorScheme });
    expect.soft(await faintLetters(page, within), `${where}, ${colorScheme}`).toEqual([]);
  }
}
