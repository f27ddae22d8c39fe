import type { Locator, Page } from "@playwright/test";
import { expect, test } from "../lab";
import type { LabServer } from "../lab-server";
import { expectClean, expectFits, expectReadable, isPhone, nameOf, SCHEMES, SCREENS, showOn } from "../screens";

/** Dialogs, by the key that opens them. */
const DIALOGS = [
  { key: "?", title: "Keyboard" },
  { key: "n", title: "New bench" },
  { key: "S", title: "Share this experiment" },
];
const MENUS = [/: change bench\b/, /: change it$/, "Add or close panels", "Choose signals", /^Export/];

const PAGES: [string, (page: Page) => Locator][] = [
  ["scores", (page) => page.getByRole("region", { name: "Curves" })],
  ["design", (page) => page.getByRole("img", { name: /^Bode diagram/ })],
  ["theory", (page) => page.getByRole("heading", { name: "Equations" })],
  ["theory/positive-real", (page) => page.getByRole("img", { name: /^Real part/ })],
  ["theory/excitation", (page) => page.getByRole("heading", { name: "Does the input excite enough?" })],
  ["theory/stability", (page) => page.getByText(/of the map is unstable/)],
  ["gallery", (page) => page.getByRole("list", { name: "Experiments" }).getByRole("listitem").nth(5)],
];

async function show(page: Page, server: LabServer, place: string): Promise<void> {
  await page.request.get(server.url);
  await page.goto(`${server.origin}/${place}`);
}

for (const [name, whole] of PAGES)
  test(`the page ${name} fits every screen`, async ({ page, server }) => {
    await show(page, server, name);
    await expect(whole(page)).toBeVisible();
    if (name === "gallery") await page.getByRole("button", { name: "notes" }).first().click();
    await expectFits(page, name);
  });

test("the designer of a gyroscope fits every screen", async ({ page, server }) => {
  await show(page, server, "design");
  await page.getByRole("combobox", { name: "Device" }).selectOption("gyro-a");
  await expect(page.getByText("Angle random walk")).toBeVisible();
  await expectFits(page, "the designer of a gyroscope");
});

test("the pages of a run, a comparison and a campaign fit every screen", async ({ page, server }) => {
  const start = (path: string, body: object) => server.ask<{ id: string }>("POST", path, body).then(({ id }) => id);
  const run = await start("/runs", { scenario: "ch5-seven-step", seed: 1 });
  const other = await start("/runs", { scenario: "ch5-seven-step", seed: 2 });
  const sweep = await start("/sweeps", {
    sweep: {
      schema: 1,
      scenario: "ch5-seven-step",
      seeds: { first: 1, count: 2 },
      grid: { "sensor.noise_um": [0.05, 0.2] },
    },
  });
  for (const job of [`/runs/${run}`, `/runs/${other}`, `/sweeps/${sweep}`])
    await expect.poll(() => server.ask<{ state: string }>("GET", job).then(({ state }) => state)).toBe("done");
  const result = page.getByRole("region", { name: "Result" });
  await show(page, server, `runs/${run}`);
  await expect(result.getByText(/^digest/)).toBeVisible();
  await page.getByText("Campaign", { exact: true }).click();
  await expectFits(page, "a run");
  await show(page, server, `runs/${sweep}`);
  await expect(result.getByRole("figure").first()).toBeVisible();
  await expectFits(page, "a campaign");
  await show(page, server, `runs/${run},${other}`);
  await expect(result.getByRole("table")).toBeVisible();
  await expectFits(page, "a comparison");
});

test("no dialog overlaps or is cut, on any screen", async ({ page, openBench }) => {
  await openBench("lab");
  await page.getByRole("button", { name: "Pause" }).click();
  for (const { key, title } of DIALOGS) {
    await page.keyboard.press(key);
    const sheet = page.getByRole("dialog", { name: title });
    await expect(sheet).toBeVisible();
    await expectFits(page, title, "[role=dialog]");
    if (title === "New bench") {
      await sheet.getByRole("button", { name: /^Open a scenario from disk/ }).click();
      await expect(page.getByRole("dialog", { name: "Mine" })).toBeVisible();
      await expectFits(page, "Mine", "[role=dialog]");
    }
    await page.keyboard.press("Escape");
    await expect(page.getByRole("dialog")).toHaveCount(0);
  }
});

test("no menu overlaps or is cut, on any screen", async ({ page, openBench }) => {
  await openBench("lab");
  for (const screen of SCREENS.filter((screen) => !isPhone(screen))) {
    await showOn(page, screen);
    for (const name of [...MENUS, "Step", "More"]) {
      await page
        .getByRole("button", { name, exact: typeof name === "string" })
        .or(page.getByTitle(name))
        .first()
        .click();
      const open = page.locator("[data-portal] :is([role=menu], [role=dialog])").first();
      await expect(open).toBeVisible();
      await expectClean(page, `${name} at ${nameOf(screen)}`, "[data-portal]");
      await page.mouse.click(2, 2);
      await expect(open).toBeHidden();
    }
  }
});

test("no notice overlaps or is cut, on any screen", async ({ page, openBench }) => {
  await openBench("lab");
  const undo = page.locator(".mantine-Notification-root").getByRole("button", { name: "Undo" }).last();
  const tab = page.getByRole("tab", { name: "Tracking error" });
  for (const screen of SCREENS) {
    await showOn(page, isPhone(screen) ? SCREENS[0] : screen);
    await tab.focus();
    await page.keyboard.press("Delete");
    await undo.hover(); // the notice stays while the pointer rests on it
    if (isPhone(screen)) await showOn(page, screen);
    await expectClean(page, `a notice at ${nameOf(screen)}`);
    if (isPhone(screen)) break;
    await undo.click();
    await expect(tab).toBeVisible();
  }
});

test("notices can be read in both schemes", async ({ page, openBench }) => {
  await openBench("lab");
  await page.keyboard.press("k");
  await page.getByRole("tab", { name: "Voltage" }).focus();
  await page.keyboard.press("Delete");
  // letters that were not measured must not pass: the notices stay while the pointer rests on one
  await page.getByText("Voltage closed.").hover();
  for (const scheme of SCHEMES) {
    await expectReadable(page, "notices", scheme, ".mantine-Notifications-root");
    for (const said of ["Moment kept", "Voltage closed."]) await expect(page.getByText(said)).toBeVisible();
  }
});
