import type { Locator, Page } from "@playwright/test";
import { expect, pictureOf, SCOPE_CANVAS, test } from "./lab";
import { SCREENS, showOn } from "./screens";
import { seriousViolations } from "./serious-violations";

interface Capture {
  tick: number;
  trigger_tick: number;
  start_tick: number;
  end_tick: number;
}

const shown = (page: Page) => new URL(page.url()).searchParams.get("bench") ?? "";
const motionOf = (page: Page) => page.getByRole("region", { name: /^Scope: plant\.displacement/ });
const wordsOf = (scope: Locator) => scope.getByRole("group", { name: "Captures", exact: true }).getByRole("status");

test("the captures of a trigger outlive the history: previous, next, newest, by keys, to single ticks, and live again", async ({
  page,
  server,
  openBench,
}) => {
  await openBench("lab", { samples: 10_000_000 });
  const bench = shown(page);
  const scope = motionOf(page);
  await expect(scope.getByRole("group", { name: "Captures", exact: true })).toBeHidden();
  await scope.getByRole("button", { name: "Trigger", exact: true }).click();
  const words = wordsOf(scope);
  await server.ask("POST", `/benches/${bench}/commands`, { kind: "time_scale", value: 0.05 });
  await expect(words).toHaveText(/^50\scaptures kept$/, { timeout: 120_000 });
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await expect(words).toHaveText(/^50\scaptures kept$/);

  const { dt_ms: dt } = await server.ask<{ dt_ms: number }>("GET", `/benches/${bench}`);
  const list = async () =>
    (await server.ask<{ triggers: { captures: Capture[] }[] }>("GET", `/benches/${bench}/captures`)).triggers[0]
      .captures;
  const captures = await list();
  const at = (index: number) =>
    `capture ${index + 1} of 50 at ${(captures[index].trigger_tick * dt).toFixed(3)}\u00a0ms`;
  const picture = () => pictureOf(page, SCOPE_CANVAS);
  const live = await picture();

  // to the newest, then back one by one; the scope stands on each
  await scope.getByRole("button", { name: "Previous capture" }).click();
  await expect(words).toHaveText(at(49));
  await expect(scope.getByRole("button", { name: "PAST → LIVE" })).toBeVisible();
  await expect(scope.getByRole("button", { name: "Next capture" })).toBeDisabled();
  await scope.getByRole("button", { name: "Previous capture" }).click();
  await expect(words).toHaveText(at(48));
  const plot = scope.getByRole("group", { name: /^Plot\./ });
  await plot.focus();
  await page.keyboard.press("PageUp");
  await expect(words).toHaveText(at(47));
  await page.keyboard.press("PageDown");
  await expect(words).toHaveText(at(48));
  await scope.getByRole("slider", { name: "Capture" }).fill("0");
  await expect(words).toHaveText(at(0));
  await expect.poll(picture).not.toBe(live);
  await seriousViolations(page).then((found) => expect(found).toEqual([]));

  // down to single ticks, and out again
  const whole = await picture();
  await plot.focus();
  for (let i = 0; i < 12; i += 1) await page.keyboard.press("+");
  await expect.poll(picture).not.toBe(whole);
  await expect(words).toHaveText(at(0));
  await page.keyboard.press("End");
  await expect(words).toHaveText(at(49));
  await page.keyboard.press("l");
  await expect(words).toHaveText(/^50\scaptures kept$/);
  await expect.poll(picture).toBe(live);

  // single sweep, another page and a page that comes back find the same, although the history has gone on
  await page.reload();
  await expect(words).toHaveText(/^50\scaptures kept$/);
  await scope.getByRole("slider", { name: "Capture" }).fill("10");
  await expect(words).toHaveText(at(10));
  await expect.poll(picture).not.toBe(live);
  const old = await picture();
  await server.ask("POST", `/benches/${bench}/commands`, { kind: "time_scale", value: null });
  await server.ask("POST", `/benches/${bench}/commands`, { kind: "start" });
  await expect
    .poll(async () => (await server.ask<{ first_tick: number }>("GET", `/benches/${bench}`)).first_tick, {
      timeout: 120_000,
    })
    .toBeGreaterThan(captures[49].end_tick);
  await server.ask("POST", `/benches/${bench}/commands`, { kind: "pause" });
  expect(await list()).toEqual(captures); // while it stands on one, the scope takes no others
  await expect(words).toHaveText(at(10));
  expect(await picture()).toBe(old);
  await scope.getByRole("slider", { name: "Capture" }).fill("11");
  await expect(words).toHaveText(at(11));
  await scope.getByRole("slider", { name: "Capture" }).fill("10");
  await expect(words).toHaveText(at(10));
  await expect.poll(picture).toBe(old); // every sample of it is still there
});

test("another level has captures of its own, and one of the old level is left", async ({ page, openBench }) => {
  await openBench("lab", { samples: 1_000_000 });
  const scope = motionOf(page);
  await scope.getByRole("button", { name: "Trigger", exact: true }).click();
  const words = wordsOf(scope);
  await expect(words).toHaveText(/^\d+\scaptures kept$/, { timeout: 120_000 });
  await scope.getByRole("button", { name: "Previous capture" }).click();
  await expect(words).toHaveText(/^capture \d+ of \d+ at/);
  await scope.getByRole("button", { name: /↗/ }).click();
  await page.getByRole("textbox", { name: "Level" }).fill("1000");
  await expect(words).toHaveText("no captures yet");
  await expect(scope.getByRole("button", { name: "Previous capture" })).toBeDisabled();
});

test("the strip has room on every screen", async ({ page, openBench }) => {
  await openBench("lab");
  for (const screen of SCREENS) {
    await showOn(page, screen);
    const scope = motionOf(page).first();
    if (await scope.getByRole("button", { name: "Trigger", exact: true }).isHidden()) continue;
    const trigger = scope.getByRole("button", { name: "Trigger", exact: true });
    if ((await trigger.getAttribute("aria-pressed")) === "false") await trigger.click();
    const strip = scope.getByRole("group", { name: "Captures", exact: true });
    await expect(strip).toBeVisible();
    expect(await strip.evaluate((box) => box.scrollWidth <= box.clientWidth)).toBe(true);
  }
});
