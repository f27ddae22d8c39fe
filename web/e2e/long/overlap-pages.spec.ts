import type { Locator } from "@playwright/test";
import { expect, test } from "../lab";
import { expectClean, expectFits, expectReadable, isPhone, nameOf, SCHEMES, SCREENS, showOn } from "../screens";

/** Dialogs, by the key that opens them. */
const DIALOGS = [
  { key: "?", title: "Keyboard" },
  { key: "n", title: "New bench" },
  { key: "S", title: "Share this experiment" },
];
const MENUS = [/: change bench$/, /: change it$/, "Add or close panels", "Choose signals", /^Export/];

test("no page overlaps or is cut, on any screen", async ({ page, server }) => {
  const { id: run } = await server.ask<{ id: string }>("POST", "/runs", { scenario: "ch5-seven-step", seed: 1 });
  const { id: other } = await server.ask<{ id: string }>("POST", "/runs", { scenario: "ch5-seven-step", seed: 2 });
  const { id: sweep } = await server.ask<{ id: string }>("POST", "/sweeps", {
    sweep: {
      schema: 1,
      scenario: "ch5-seven-step",
      seeds: { first: 1, count: 2 },
      grid: { "sensor.noise_um": [0.05, 0.2] },
    },
  });
  for (const job of [`/runs/${run}`, `/runs/${other}`, `/sweeps/${sweep}`])
    await expect.poll(() => server.ask<{ state: string }>("GET", job).then(({ state }) => state)).toBe("done");
  await page.request.get(server.url);
  const show = async (address: string, whole: Locator) => {
    await page.goto(`${server.origin}/?${address}`);
    await expect(whole).toBeVisible();
  };
  const result = page.getByRole("region", { name: "Result" });

  await show(`page=runs&run=${run}`, result.getByText(/^digest/));
  await page.getByText("Campaign", { exact: true }).click();
  await expectFits(page, "a run");
  await show(`page=runs&sweep=${sweep}`, result.getByRole("figure").first());
  await expectFits(page, "a campaign");
  await show(`page=runs&compare=${run},${other}`, result.getByRole("table"));
  await expectFits(page, "a comparison");
  await show("page=benchmark", page.getByRole("region", { name: "Curves" }));
  await expectFits(page, "the benchmark");
  await show("page=designer", page.getByRole("img", { name: /^Bode diagram/ }));
  await expectFits(page, "the designer");
  await page.getByRole("combobox", { name: "Device" }).selectOption("gyro-a");
  await expect(page.getByText("Angle random walk")).toBeVisible();
  await expectFits(page, "the designer of a gyroscope");
  await show("page=theory", page.getByText(/of the map is unstable/));
  await expectFits(page, "theory");
  await show("page=gallery", page.getByRole("list", { name: "Experiments" }).getByRole("listitem").nth(5));
  await page.getByRole("button", { name: "notes" }).first().click();
  await expectFits(page, "the gallery");
});

test("no dialog, menu or notice overlaps or is cut, on any screen", async ({ page, openBench }) => {
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
  for (const screen of SCREENS.filter((screen) => !isPhone(screen))) {
    await showOn(page, screen);
    for (const name of [...MENUS, screen.width < 1400 ? "More" : "Layout"]) {
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
  // a notice goes by itself, so each screen has its own
  const undo = page.locator(".mantine-Notification-root").getByRole("button", { name: "Undo" }).last();
  const tab = page.getByRole("tab", { name: "Voltage" });
  for (const screen of SCREENS) {
    await showOn(page, isPhone(screen) ? SCREENS[0] : screen);
    await tab.focus();
    await page.keyboard.press("Delete");
    await expect(undo).toBeVisible();
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
