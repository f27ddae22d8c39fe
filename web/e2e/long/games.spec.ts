import type { Page } from "@playwright/test";
import { benchOf, expect, test } from "../classroom";
import { front } from "../lab";
import { expectFits } from "../screens";
import { seriousViolations } from "../serious-violations";

interface Play {
  attempts: { outcome: { points: number } }[];
  bench: string | null;
  kinds: { name: string; title: string }[];
}

interface Shown {
  faults: { name: string }[];
}

const panelOf = (page: Page) => page.locator("section[aria-label='Games']");

async function fill(page: Page, name: RegExp, value: string): Promise<void> {
  const field = panelOf(page).getByRole("textbox", { name });
  await field.fill(value);
  await field.press("Enter");
}

/** Points as the page writes them. */
const written = (points: number) => points.toFixed(1).replace("-", "\u2212");

test("the panel fits on every screen", async ({ page, openBench }) => {
  await openBench("lab");
  await front(page, "Lesson", "Games");
  for (const game of ["be-the-filter", "fool-the-bank"]) {
    await panelOf(page).getByRole("combobox", { name: "Game", exact: true }).selectOption(game);
    await expect(panelOf(page).getByText("How points are counted")).toBeVisible();
    await expectFits(page, `the game ${game}`, "section[aria-label='Games']", "games");
  }
});

test("fool the bank: faults are tried and healed, and the answer tells the edge", async ({
  page,
  openBench,
  server,
}) => {
  await openBench("lab");
  await front(page, "Lesson", "Games");
  const panel = panelOf(page);
  await panel.getByRole("combobox", { name: "Game", exact: true }).selectOption("fool-the-bank");
  await fill(page, /^Seed/, "12");
  await panel.getByRole("button", { name: "Play on a new bench" }).click();
  await expect(panel.getByRole("button", { name: "Try it on the bench" })).toBeVisible();
  const play = () => server.ask<Play>("GET", "/games/fool-the-bank?seed=12");
  const { bench, kinds } = await play();
  await panel.getByRole("combobox", { name: "Fault" }).selectOption(kinds[0].name);
  await fill(page, /^Severity/, "2");
  await panel.getByRole("button", { name: "Try it on the bench" }).click();
  const acting = async () => (await server.ask<Shown>("GET", `/benches/${bench}`)).faults.map(({ name }) => name);
  await expect.poll(acting).toEqual([kinds[0].name]);
  await panel.getByRole("button", { name: "Heal" }).click();
  await expect.poll(acting).toEqual([]);
  await panel.getByRole("button", { name: "Hand in" }).click();
  await expect(panel.getByRole("status")).toContainText(/The smallest it finds is|finds this fault nowhere/);
  expect(await seriousViolations(page)).toEqual([]);
  const [{ outcome }] = (await play()).attempts;
  await expect(panel.getByRole("row").nth(1)).toContainText(written(outcome.points));
  await expect(panel.getByLabel("Solution")).toContainText("Sensor noise");
  await expect(page.getByText("A game is played here")).toHaveCount(0);
});

test("a class: the table has everybody's points, and settings only once one's own game is over", async ({
  server,
  student,
}) => {
  const [ada, ben] = await Promise.all([student("Ada"), student("Ben")]);
  for (const [one, mass] of [
    [ada, "1.1"],
    [ben, "1.2"],
  ] as const) {
    await one.goto(`${server.origin}/?bench=${benchOf(one)}&layout=lab`);
    await front(one, "Lesson", "Games");
    await fill(one, /^Mass/, mass);
    await panelOf(one).getByRole("button", { name: "Hand in" }).click();
    await expect(panelOf(one).getByText("4 attempts left")).toBeVisible();
  }
  const table = panelOf(ben).getByRole("table");
  await expect(table).toContainText("Ada");
  await expect(table).toContainText("mass 1.2");
  await expect(table).not.toContainText("mass 1.1");
  await panelOf(ben).getByRole("button", { name: "Show the solution" }).click();
  await expect(table).toContainText("mass 1.1");
});
