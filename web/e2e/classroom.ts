import type { Browser, Page } from "@playwright/test";
import { expect } from "./lab";
import type { LabServer } from "./lab-server";
import type { Screen } from "./screens";

export interface Group {
  id: string;
  code: string;
}

/** Open a class, as the teacher's page does. */
export const openClass = (server: LabServer, name = "Tuesday"): Promise<Group> =>
  server.ask<Group>("POST", "/classes", { name });

/** The page of a student who has joined, without the 3D view. */
export async function student(
  browser: Browser,
  server: LabServer,
  group: Group,
  name: string,
  viewport: Screen = { width: 1366, height: 768 },
): Promise<Page> {
  const context = await browser.newContext({ viewport });
  const page = await context.newPage();
  await page.route("**/3d/", (route) => route.fulfill({ contentType: "text/html", body: "" }));
  const answer = await page.request.post(`${server.origin}/join`, {
    form: { code: group.code, name },
    headers: { origin: server.origin },
    maxRedirects: 0,
  });
  expect(answer.status()).toBe(303);
  await page.goto(server.origin);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  return page;
}

/** The bench that a page shows, as its address says. */
export const benchOf = (page: Page): string => new URL(page.url()).searchParams.get("bench") ?? "";
