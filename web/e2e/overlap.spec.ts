import type { Page } from "@playwright/test";
import { expect, HYPOTHESES, test } from "./lab";
import type { LabServer } from "./lab-server";
import { layoutFaults } from "./layout-faults";
import { SCREENS, showOn } from "./screens";

/** Panels that stand in no layout of a resonator. */
const OTHERS = ["Controllers", "Parameter sets"];

const RESONATOR = {
  scenario: "ch5-seven-step",
  set: {
    title: "Seven steps of a resonator, under a title as long as the titles of experiments become",
    "diagnosers.imm": { kind: "imm", hypotheses: HYPOTHESES },
    "twins.variable_structure": { controller: { kind: "stvsc" } },
  },
};
const GYROSCOPE = { scenario: "gyro-diagnosis", set: { "readouts.allan": { kind: "allan" } } };

test.describe.configure({ timeout: 150_000 });

async function open(page: Page, server: LabServer, bench: object): Promise<void> {
  await page.request.get(server.url);
  // the drawing itself has tests of its own; here it would only take the machine
  await page.route("**/3d/", (route) => route.fulfill({ contentType: "text/html", body: "" }));
  const { id } = await server.ask<{ id: string }>("POST", "/benches", bench);
  await page.goto(`${server.origin}/?bench=${id}`);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
}

/** What comes or goes may lie over something for a moment. */
async function expectClean(page: Page, where: string, within?: string): Promise<void> {
  await expect.soft.poll(() => layoutFaults(page, within), { message: where, timeout: 1000 }).toEqual([]);
}

/** Bring the panels of a rank to the front in all groups at once; their names, none when no group has as many. */
const bringToFront = (page: Page, rank: number): Promise<string> =>
  page.evaluate(async (rank) => {
    const tabs = [...document.querySelectorAll(".dv-groupview")].flatMap(
      (group) => group.querySelectorAll<HTMLElement>("[role=tab]")[rank] ?? [],
    );
    for (const tab of tabs) tab.click();
    for (let frame = 0; frame < 3; frame += 1) await new Promise(requestAnimationFrame);
    return tabs.map((tab) => tab.textContent).join(", ");
  }, rank);

/** Every panel of the layout behind a key, as it stands at first. */
async function walkDock(page: Page, key: string, look: (where: string) => Promise<void>): Promise<void> {
  await page.evaluate(() => {
    for (const kept of Object.keys(localStorage))
      if (kept.startsWith("combbench.layout.4")) localStorage.removeItem(kept);
  });
  await page.keyboard.press(key);
  if (key === "2")
    for (const title of OTHERS) {
      await page.getByRole("button", { name: "Add or close panels" }).last().click();
      await page.getByRole("menuitem", { name: title, exact: true }).click();
    }
  for (let rank = 0; ; rank += 1) {
    const names = await bringToFront(page, rank);
    if (!names) return;
    await look(names);
  }
}

/** Every panel a phone can open. */
async function walkPhone(page: Page, look: (where: string) => Promise<void>): Promise<void> {
  const choice = page.getByRole("combobox", { name: "Another panel" });
  const kinds = await choice.locator("option").evaluateAll((all) => all.map((o) => (o as HTMLOptionElement).value));
  for (const kind of kinds) {
    await choice.selectOption(kind);
    await look(kind || "what it shows anyway");
  }
}

for (const [device, bench] of Object.entries({ resonator: RESONATOR, gyroscope: GYROSCOPE }))
  test(`no panel of a ${device} overlaps or is cut, on any screen`, async ({ page, server }) => {
    await open(page, server, bench);
    for (const screen of SCREENS) {
      await showOn(page, screen);
      const at = `${device} at ${screen.width} x ${screen.height}`;
      if (screen.width < 600) await walkPhone(page, (where) => expectClean(page, `${at}: ${where}`));
      else
        for (const key of "123") {
          await walkDock(page, key, (where) => expectClean(page, `${at}, layout ${key}: ${where}`));
        }
    }
  });
