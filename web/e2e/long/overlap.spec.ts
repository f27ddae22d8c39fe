import type { Page } from "@playwright/test";
import { expect, front, HYPOTHESES, openPanel, test } from "../lab";
import type { LabServer } from "../lab-server";
import {
  expectClean,
  expectReadable,
  isPhone,
  nameOf,
  openOnPhone,
  SCHEMES,
  SCREENS,
  showOn,
  viewsOnPhone,
} from "../screens";

const RESONATOR = {
  scenario: "ch5-seven-step",
  set: {
    title: "Seven steps of a resonator, under a title as long as the titles of experiments become",
    "diagnosers.imm": { kind: "imm", hypotheses: HYPOTHESES },
    "twins.variable_structure": { controller: { kind: "stvsc" } },
  },
};
const GYROSCOPE = { scenario: "gyro-diagnosis", set: { "readouts.allan": { kind: "allan" } } };

/** Views with a place in no laboratory, or in the research layout alone. */
const ADDED = ["3D", "Spectrum", "Phase plane"];

/** The keys of the layouts. */
const LAYOUTS = { lecture: "1", lab: "2", research: "3" };

/** Open a bench that runs. */
async function open(page: Page, server: LabServer, bench: object): Promise<string> {
  const { id } = await server.ask<{ id: string }>("POST", "/benches", bench);
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?bench=${id}&layout=lab`);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  return id;
}

/** The same, after it has found a fault and says why. */
async function openFound(page: Page, server: LabServer, bench: object): Promise<void> {
  await open(page, server, bench);
  await page.getByRole("button", { name: "Skip" }).click();
  const steps = page.getByRole("region", { name: "Steps of the scenario" });
  const later = async () => {
    await server.advance(2);
    return steps.textContent();
  };
  await expect.poll(later).toMatch(/[3-9] of \d/);
  await server.advance(1);
  await page.keyboard.press("w");
}

/** Bring the panels of a rank to the front, in all groups at once; their names, none when no group has as many. */
const bringToFront = (page: Page, rank: number): Promise<string> =>
  page.evaluate(async (rank) => {
    const tabs = Array.from(document.querySelectorAll(".dv-groupview")).flatMap(
      (group) => group.querySelectorAll<HTMLElement>("[role=tab]")[rank] ?? [],
    );
    for (const tab of tabs) tab.click();
    for (let frame = 0; frame < 2; frame += 1) await new Promise(requestAnimationFrame);
    return tabs.map((tab) => tab.textContent).join(", ");
  }, rank);

/** Every panel of a layout in its first state, and some more. */
async function walkDock(page: Page, key: string, added: string[], look: (where: string) => Promise<void>) {
  await page.evaluate(() => {
    for (const name of Object.keys(localStorage))
      if (name.startsWith("combbench.layout.4")) localStorage.removeItem(name);
  });
  await page.keyboard.press(key);
  for (const title of added) {
    await openPanel(page, title);
  }
  for (let rank = 0; ; rank += 1) {
    const names = await bringToFront(page, rank);
    if (!names) return;
    await look(names);
    for (let view = 1; ; view += 1) {
      const turned = await turnTo(page, view);
      if (!turned) break;
      await look(turned);
    }
  }
}

/** Turn the panels in front to their views of a rank; their names, none when no panel has as many. */
async function turnTo(page: Page, rank: number): Promise<string> {
  const turned: string[] = [];
  for (const choice of await page.locator(".dock-views, .dock-view[aria-haspopup=menu]").all()) {
    const isRow = (await choice.getAttribute("role")) === "group";
    if (!isRow) {
      await choice.click();
      await expect(page.getByRole("menuitem").first()).toBeFocused();
    }
    const view = (isRow ? choice.getByRole("button") : page.getByRole("menuitem")).nth(rank);
    if (await view.count()) {
      turned.push(await view.innerText());
      await view.click();
    } else if (!isRow) await page.keyboard.press("Escape");
    await expect(page.getByRole("menu")).toHaveCount(0);
  }
  return turned.join(", ");
}

/** Every panel that a phone can open. */
async function walkPhone(page: Page, look: (where: string) => Promise<void>) {
  for (const view of await viewsOnPhone(page)) {
    await openOnPhone(page, view);
    await look(view);
  }
}

for (const [device, bench] of Object.entries({ resonator: RESONATOR, gyroscope: GYROSCOPE })) {
  for (const screen of SCREENS) {
    const at = `${device} at ${nameOf(screen)}`;
    const walk = (where: string, walked: (page: Page, look: (shown: string) => Promise<void>) => Promise<void>) =>
      test(`no panel of a ${at} overlaps or is cut ${where}`, async ({ page, server }) => {
        await openFound(page, server, bench);
        await showOn(page, screen);
        await walked(page, (shown) => expectClean(page, `${at}: ${shown}`));
      });
    if (isPhone(screen)) walk("below the scope", walkPhone);
    else
      for (const [layout, key] of Object.entries(LAYOUTS))
        walk(`in the layout ${layout}`, (page, look) => walkDock(page, key, layout === "lab" ? ADDED : [], look));
  }

  for (const scheme of SCHEMES)
    test(`the letters of all panels of a ${device} can be read in the ${scheme} scheme`, async ({ page, server }) => {
      test.slow(); // axe reads every view
      await openFound(page, server, bench);
      await showOn(page, SCREENS[0]);
      await walkDock(page, "2", ADDED, (where) => expectReadable(page, `${device}: ${where}`, scheme, ".dv-groupview"));
    });
}

for (const scenario of ["gyro-first-look", "gyro-whole-angle", "gyro-comb-device"])
  test(`the longer numbers and names of ${scenario} fit every screen`, async ({ page, server }) => {
    await open(page, server, { scenario });
    for (const screen of SCREENS) {
      await showOn(page, screen);
      await expectClean(page, `${scenario} at ${nameOf(screen)}`);
    }
  });

test("an Allan deviation that has gathered for long fits too", async ({ page, server }) => {
  const id = await open(page, server, { scenario: "gyro-allan" });
  await server.ask("POST", `/benches/${id}/commands`, { kind: "time_scale", value: null });
  await server.advance(2);
  const figures = page.getByRole("region", { name: "Allan deviation" }).getByRole("row");
  for (const screen of SCREENS) {
    await showOn(page, screen);
    if (isPhone(screen)) await openOnPhone(page, "allan");
    else await front(page, "Rate");
    await expect(figures.nth(1)).toBeVisible();
    await expectClean(page, `Allan deviation at ${nameOf(screen)}`);
  }
});
