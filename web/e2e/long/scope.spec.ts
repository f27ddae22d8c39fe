import type { Locator, Page } from "@playwright/test";
import { chooseTool, expect, openPanel, test } from "../lab";
import { isPhone, SCREENS, showOn } from "../screens";

/** Parts that a scope lacks at first sight: its axis of time, one row of names, traces that fill it. */
const lacks = (scope: Locator): Promise<string[]> =>
  scope.evaluate((panel) => {
    const field = panel.querySelector("[data-testid=field]")?.getBoundingClientRect();
    const canvas = panel.querySelector("canvas");
    if (!field || !canvas) return ["nothing is drawn"];
    const box = panel.getBoundingClientRect();
    const { width, height } = canvas;
    const { data } = (canvas.getContext("2d") as CanvasRenderingContext2D).getImageData(0, 0, width, height);
    const rows = Array.from({ length: height }, (_, y) => y).filter((y) => {
      for (let x = Math.round(width * 0.1); x < width * 0.9; x += 1) {
        const at = 4 * (y * width + x);
        const [r, g, b] = [data[at], data[at + 1], data[at + 2]];
        if (data[at + 3] >= 128 && Math.max(r, g, b) - Math.min(r, g, b) >= 60) return true; // grid and text are grey
      }
      return false;
    });
    const traces = (((rows.at(-1) ?? 0) - (rows[0] ?? 0)) * canvas.clientHeight) / height;
    const names = panel.querySelector("[aria-label='Signals']")?.getBoundingClientRect();
    return [
      ...(box.bottom - field.bottom > 15 ? [] : ["the axis of time"]),
      ...(traces > 0.4 * box.height ? [] : ["traces that fill it"]),
      ...(names && names.height < 30 ? [] : ["one row of names"]),
      ...(panel.scrollHeight <= panel.clientHeight ? [] : ["room for all of it"]),
    ];
  });

test("at first sight every scope has its axis, one row of names, and traces that fill it", async ({
  page,
  server,
  openBench,
}) => {
  await page.setViewportSize(SCREENS[0]);
  await openBench("research");
  await server.advance(4);
  for (const key of ["3", "2", "1"]) {
    await page.keyboard.press(key);
    const scopes = page.getByRole("region", { name: /^Scope: / });
    await expect(scopes).toHaveCount(key === "1" ? 2 : 1);
    for (const scope of await scopes.all()) {
      await expect(scope.getByTestId("field")).toBeInViewport({ ratio: 1 });
      await expect.poll(() => lacks(scope), `layout ${key}`).toEqual([]);
    }
  }
});

test("the strip of captures has room on every screen", async ({ page, openBench }) => {
  await openBench("lab");
  const scope = page.getByRole("region", { name: /^Scope: plant\.displacement/ }).first();
  await chooseTool(scope, /^Trigger/);
  for (const screen of SCREENS) {
    await showOn(page, screen);
    if (isPhone(screen)) await chooseTool(scope, /^Trigger/); // a phone has a scope of its own
    const strip = scope.getByRole("group", { name: "Captures", exact: true });
    await expect(strip).toBeVisible();
    await expect.poll(() => strip.evaluate((box) => box.scrollWidth <= box.clientWidth)).toBe(true);
  }
});

/** Sizes of the text in a lecture: letters of a tab, px, and the names of the lanes, which a canvas draws. */
const letters = (page: Page): Promise<number[]> =>
  page.evaluate(() => {
    const tab = document.querySelector("[role=tab]");
    const lanes = document.querySelector("[title*='m+5']");
    return [Number.parseFloat(tab ? getComputedStyle(tab).fontSize : "0"), lanes?.clientWidth ?? 0];
  });

test("the letters of a lecture grow with the window, on canvases too, and a chosen layout stays", async ({
  page,
  openBench,
}) => {
  const sizes: number[][] = [[0, 0]];
  await openBench("lecture");
  for (const [width, height] of [
    [1366, 768],
    [1920, 1080],
    [3840, 2160],
  ]) {
    await page.setViewportSize({ width, height });
    const last = sizes.at(-1) ?? [0, 0];
    await expect.poll(async () => (await letters(page)).every((size, i) => size > last[i] * 1.2)).toBe(true);
    sizes.push(await letters(page));
  }
  expect(sizes[3][0] / sizes[1][0]).toBeGreaterThan(2.5);

  await page.setViewportSize({ width: 1440, height: 900 });
  const html = page.locator("html");
  await page.keyboard.press("2");
  await expect(html).toHaveAttribute("data-size", "normal");
  await page.goto(page.url().replace(/&layout=\w+/, ""));
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await expect(html).toHaveAttribute("data-size", "normal");
});

/** How much longer one axis of the phase plane is than the other, px, by its lines. */
function outOfSquare(canvas: HTMLCanvasElement): number {
  const context = canvas.getContext("2d") as CanvasRenderingContext2D;
  const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
  const [across, up] = [[] as number[], [] as number[]];
  for (let at = 0; at < data.length; at += 4) {
    if (data[at + 3] <= 250 || ![185, 194, 204].every((value, k) => Math.abs(data[at + k] - value) < 3)) continue;
    across.push((at / 4) % canvas.width);
    up.push(Math.floor(at / 4 / canvas.width));
  }
  const length = (places: number[]) =>
    places.reduce((a, b) => Math.max(a, b), 0) - places.reduce((a, b) => Math.min(a, b), canvas.width);
  return across.length === 0 ? Number.POSITIVE_INFINITY : Math.abs(length(across) - length(up));
}

test("the phase plane is square at any width", async ({ page, server, openBench }) => {
  await openBench();
  await openPanel(page, "Phase plane");
  for (const width of [1366, 1920, 820]) {
    await page.setViewportSize({ width, height: 768 });
    await server.advance(1);
    const canvas = page.locator("section[aria-label='Phase plane'] canvas");
    await expect.poll(() => canvas.evaluate(outOfSquare)).toBeLessThanOrEqual(2);
  }
});

test("a lecture has few buttons without words, and room for a plot below a comparison", async ({
  page,
  server,
  openBench,
}) => {
  await page.setViewportSize(SCREENS[0]);
  await openBench("lecture");
  await server.advance(4);
  const wordless = () =>
    page
      .locator("button:has(svg)")
      .evaluateAll(
        (all) =>
          all.filter(
            (one) => !one.textContent && one.checkVisibility({ opacityProperty: true, visibilityProperty: true }),
          ).length,
      );
  await expect.poll(wordless).toBeLessThanOrEqual(8);
  await page.getByRole("button", { name: /^Inject \+5.*Added mass$/ }).click();
  for (const scope of await page.getByRole("region", { name: /^Scope: / }).all()) {
    await expect(scope.getByRole("region", { name: "Before and after" })).toContainText("Added mass");
    const field = scope.locator(".u-over, [data-testid=field]");
    await expect.poll(() => field.evaluate((plot) => plot.clientHeight)).toBeGreaterThan(175);
  }
});
