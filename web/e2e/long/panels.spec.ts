import type { Page } from "@playwright/test";
import { benchOf } from "../classroom";
import { expect, front, HYPOTHESES, test } from "../lab";
import type { LabServer } from "../lab-server";
import {
  expectClean,
  expectFits,
  expectReadable,
  openOnPhone,
  SCHEMES,
  SCREENS,
  showOn,
  viewsOnPhone,
} from "../screens";
import { seriousViolations } from "../serious-violations";

const command = (server: LabServer, id: string, body: object) => server.ask("POST", `/benches/${id}/commands`, body);

/** Open a panel of the lab layout. */
const panelOf = async (page: Page, panel: string, view: string) => {
  await front(page, panel, view);
  return page.getByRole("region", { name: view, exact: true });
};

for (const [device, scenario] of Object.entries({ resonator: "first-look", gyroscope: "gyro-diagnosis" }))
  test(`axe finds nothing serious in any panel of a ${device}`, async ({ page, server }) => {
    await page.request.get(server.url);
    const set = device === "resonator" ? { "diagnosers.imm": { kind: "imm", hypotheses: HYPOTHESES } } : {};
    const { id } = await server.ask<{ id: string }>("POST", "/benches", { scenario, set });
    await page.goto(`${server.origin}/?bench=${id}&layout=lab`);
    await showOn(page, SCREENS[3]);
    await server.advance(2);
    await expect(page.getByTestId("bench-state")).toHaveText("running"); // the views depend on the bench
    for (const view of await viewsOnPhone(page)) {
      await openOnPhone(page, view);
      expect.soft(await seriousViolations(page), view).toEqual([]);
    }
  });

test("axe finds nothing serious on the pages Theory and Designer", async ({ page, server }) => {
  await page.request.get(server.url);
  for (const [place, whole] of Object.entries({
    theory: page.getByRole("heading", { name: "Equations" }),
    "theory/positive-real": page.getByRole("img", { name: /^Real part/ }),
    "theory/excitation": page.getByRole("heading", { name: "Does the input excite enough?" }),
    "theory/stability": page.getByText(/of the map is unstable/),
    design: page.getByRole("img", { name: /^Bode diagram/ }),
  })) {
    await page.goto(`${server.origin}/${place}`);
    await expect(whole).toBeVisible();
    expect.soft(await seriousViolations(page), place).toEqual([]);
  }
});

test("parameter sets, recordings and their comparison fit every screen", async ({ page, server, openBench }) => {
  await openBench();
  const bench = benchOf(page);
  await page.getByRole("button", { name: /Sensor ?Ideal/ }).click();
  await page
    .getByRole("region", { name: /^Block/ })
    .getByRole("button", { name: "Sets…" })
    .click();
  const sets = page.getByRole("region", { name: "Sets" });
  await sets.getByRole("textbox", { name: "Keep the values of now as" }).fill("as it came");
  await sets.getByRole("button", { name: "Keep", exact: true }).click();
  await sets.getByRole("button", { name: "Compare as it came" }).click();
  await expect(sets.getByText(/^No difference in/)).toBeVisible();
  await expectFits(page, "parameter sets", undefined, "sets");

  await command(server, bench, { kind: "pause" });
  await command(server, bench, { kind: "step", ticks: 1000 });
  for (const name of ["first", "second"])
    await server.ask("POST", `/benches/${bench}/recordings`, { name, past_ticks: 500, ticks: 0 });
  const panel = await panelOf(page, "Compare", "Recordings");
  await panel.getByRole("button", { name: "Compare second with another" }).click();
  await panel.getByRole("button", { name: "Compare", exact: true }).first().click();
  await expect(panel.getByRole("status")).toHaveText(/^Pass/);
  await expectFits(page, "recordings", undefined, "recordings");
});

test("the narrator fits every screen, before anything is said and with a verdict", async ({ page, server }) => {
  const { id } = await server.ask<{ id: string }>("POST", "/benches", { scenario: "ch5-seven-step", paused: true });
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?bench=${id}&layout=lecture`);
  const caption = page.getByRole("region", { name: "What happens now" });
  await expect(caption).toContainText("Each lane of Diagnosis is one guess at the device");
  await expectFits(page, "the narrator", "section[aria-label='What happens now']");
  await command(server, id, { kind: "step", ticks: 2100 });
  await expect(caption).toContainText("the bank now favours mass +5\u00a0%");
  await expectFits(page, "a verdict as a caption", "section[aria-label='What happens now']");
  await command(server, id, { kind: "step", ticks: 6900 });
  await page.keyboard.press("3");
  await front(page, "Log", "Narrator");
  await expect(page.getByRole("list", { name: "Sentences of the narrator" }).getByRole("listitem")).toHaveCount(15);
  await expectClean(page, "the panel of the narrator", "ol[aria-label^='Sentences of the narrator']");
  for (const scheme of SCHEMES)
    await expectReadable(page, "the panel of the narrator", scheme, "ol[aria-label^='Sentences of the narrator']");
});

test("a branch, its menu, the past and the sheet that compares benches fit", async ({ page, server, openBench }) => {
  await openBench("lab", { samples: 1_000_000 });
  const bench = benchOf(page);
  await command(server, bench, { kind: "pause" });
  await command(server, bench, { kind: "step", ticks: 500 });
  await command(server, bench, { fault: "added_mass", severity: 0.05 });
  await command(server, bench, { kind: "step", ticks: 300 });
  const { id: other } = await server.ask<{ id: string }>("POST", "/benches", { scenario: "first-look", paused: true });
  await command(server, other, { kind: "step", ticks: 700 });
  await command(server, other, { fault: "added_mass", severity: 0.1 });
  await command(server, other, { kind: "step", ticks: 1000 });
  const body = { scenario: "first-look", set: { samples: 2000 }, label: "headless" };
  const { id: run } = await server.ask<{ id: string }>("POST", "/runs", body);
  await expect.poll(async () => (await server.ask<{ state: string }>("GET", `/runs/${run}`)).state).toBe("done");

  const timeline = page.getByRole("region", { name: "Timeline" });
  await timeline.getByRole("button", { name: "Compare" }).click();
  const sheet = page.getByRole("region", { name: "Branches and runs" });
  for (const [n, source] of [`b ${other}`, `h ${run}`].entries()) {
    await sheet.getByRole("combobox", { name: "Add" }).selectOption(source);
    await expect(sheet.getByRole("listitem")).toHaveCount(n + 1);
  }
  await sheet.getByRole("combobox", { name: "Aligned at" }).selectOption("the last fault of each");
  await expect(sheet.getByRole("listitem").first()).toContainText("+");
  for (const screen of SCREENS.slice(0, 3)) {
    await showOn(page, screen);
    await expectClean(page, `compare at ${screen.width}`);
  }
  await page.keyboard.press("Escape");
  await showOn(page, SCREENS[0]);
  await timeline.getByRole("button", { name: "Branch here" }).click();
  await expectClean(page, "the menu of branches");
  await page.getByRole("menuitem", { name: "With PID" }).click();
  await expect.poll(() => benchOf(page)).not.toBe(bench);
  await expect(page.getByText(/^Behind, faded: /).first()).toBeVisible();
  await expectClean(page, "a branch");
  await timeline.getByRole("slider").focus();
  await page.keyboard.press("Home");
  await expect(timeline.getByText(/^As it was at/)).toBeVisible();
  await expectClean(page, "the past of a bench");
  await showOn(page, SCREENS[3]);
  await expect(timeline).toBeHidden();
});

test("a claim fits a desk and a phone once it is judged", async ({ page, server }) => {
  const scenario = "ch3-case1-aged-mass";
  const { id } = await server.ask<{ id: string }>("POST", "/benches", { scenario, paused: true });
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?bench=${id}&layout=lab`);
  await front(page, "Published");
  const claims = page.getByRole("region", { name: "Claims" });
  await command(server, id, { kind: "step", ticks: 10_000 });
  await expect(claims.getByRole("listitem", { name: "effort ratio: holds as printed" })).toBeVisible();
  await expectFits(page, "the claims", "section[aria-label='Claims']", "claims");
});

test("a bank seen from inside fits every screen", async ({ page, openBench }) => {
  await openBench();
  const drawing = page.getByRole("combobox", { name: "Drawing" });
  for (const screen of SCREENS) {
    await showOn(page, screen);
    if (screen.width < 600) await openOnPhone(page, "schematic");
    await drawing.selectOption({ label: "Diagnosis: Kalman bank (MMAE)" });
    await expect(page.getByRole("group", { name: "Stages of Kalman bank (MMAE)" })).toBeVisible();
    await expectClean(page, `the bank at ${screen.width}`);
    for (const scheme of SCHEMES) await expectReadable(page, `the bank at ${screen.width}`, scheme);
  }
});
