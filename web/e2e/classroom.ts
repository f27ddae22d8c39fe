import type { BrowserContext, Page } from "@playwright/test";
import { test as base, expect, withoutScene } from "./lab";
import type { LabServer } from "./lab-server";
import { SCREENS, type Screen } from "./screens";

export interface Group {
  id: string;
  code: string;
}

interface ClassFixtures {
  /** The class Tuesday; it ends with the test. */
  group: Group;
  /** Open a page in another browser, without the 3D view; it closes with the test. */
  elsewhere(viewport?: Screen): Promise<Page>;
  /** Open the page of a student who joins the class. */
  student(name: string, viewport?: Screen): Promise<Page>;
}

export const test = base.extend<ClassFixtures>({
  group: async ({ server }, use) => {
    const group = await server.ask<Group>("POST", "/classes", { name: "Tuesday" });
    await use(group);
    await server.ask("DELETE", `/classes/${group.id}`);
  },
  elsewhere: async ({ browser }, use) => {
    const contexts: BrowserContext[] = [];
    await use(async (viewport = SCREENS[0]) => {
      const context = await browser.newContext({ viewport });
      contexts.push(context);
      const page = await context.newPage();
      await withoutScene(page);
      page.on("dialog", (dialog) => dialog.accept());
      return page;
    });
    await Promise.all(contexts.map((context) => context.close()));
  },
  student: async ({ elsewhere, group, server }, use) => {
    await use(async (name, viewport) => {
      const page = await elsewhere(viewport);
      await join(page, server, group.code, name);
      return page;
    });
  },
});

export { expect };

export const PHONE = SCREENS[3];

/** Join a class by the form, as a student does. */
export async function join(page: Page, server: LabServer, code: string, name: string): Promise<void> {
  await page.goto(`${server.origin}/join`);
  await page.getByLabel("Code on the wall").fill(code);
  await page.getByLabel("Your name").fill(name);
  await page.getByRole("button", { name: "Join" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
}

/** The bench that a page shows, as its address says. */
export const benchOf = (page: Page): string => new URL(page.url()).searchParams.get("bench") ?? "";

/** The line about the class above a bench. */
export const classLine = (page: Page) => page.getByRole("region", { name: "Class", exact: true });
