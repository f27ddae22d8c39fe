import { addressOf, expect, test } from "./lab";
import { LabServer } from "./lab-server";
import { seriousViolations } from "./serious-violations";

interface Library {
  cards: { id: string; verdict: string; figure: string | null }[];
  figures: { made: number; total: number; is_making: boolean };
}

test("figures are made after the first start, told of, and seen with axes and numbers", async ({ page }) => {
  const server = await LabServer.create({ COMBBENCH_FIGURES: "true" });
  try {
    await page.request.get(server.url);
    await page.goto(`${server.origin}/?page=gallery`);
    const cards = page.getByRole("list", { name: "Experiments" }).locator("> li");
    const figure = cards.nth(0).getByRole("img", { name: /^Figure of First look/ });
    await figure.waitFor({ timeout: 150_000 });
    await expect.poll(() => figure.evaluate((img) => (img as HTMLImageElement).naturalWidth)).toBeGreaterThan(0);
    const svg = await page.request.get(`${server.origin}/api/v1/gallery/first-look/figure`);
    expect(await svg.text()).toMatch(/time, ms<.*displacement, µm/);
    const beams = cards.filter({ hasText: "ch1-beam-width" });
    await expect(beams.getByText(/ours 11\.53.% \/ printed 12.%/)).toBeVisible({ timeout: 120_000 });
    await expect(beams.getByText("measured as expected")).toBeVisible();
    const { figures } = await server.ask<Library>("GET", "/gallery");
    expect(figures.total).toBe(await cards.count());
    if (figures.is_making) await expect(page.getByText(/^Figures: \d+ of \d+$/)).toBeVisible();
    await seriousViolations(page).then((found) => expect(found).toEqual([]));
  } finally {
    await server.destroy();
  }
});

test("the gallery searches, filters, runs an experiment headless, and opens it live", async ({
  page,
  server,
  openBench,
}) => {
  await openBench();
  await page.getByRole("navigation", { name: "Pages" }).getByRole("button", { name: "Gallery" }).click();
  const cards = page.getByRole("list", { name: "Experiments" }).locator("> li");
  await expect(cards.nth(0)).toContainText("first-look");
  await expect(cards.nth(1)).toContainText("first-look");
  const { cards: library } = await server.ask<Library>("GET", "/gallery");
  await expect(cards).toHaveCount(library.length);

  const search = page.getByRole("searchbox");
  await search.fill("broken truss");
  await expect(cards.first()).toContainText("ch3-case2-broken-truss");
  await search.fill("chapter 4 mrac");
  await expect(cards.first()).toContainText("ch4-");
  await search.fill("no such thing");
  await page.getByRole("button", { name: "Show all" }).click();
  await expect(cards).toHaveCount(library.length);

  await page.getByRole("combobox", { name: "Chapter" }).selectOption("5");
  await page.getByRole("combobox", { name: "Verdict" }).selectOption("ours");
  await expect(cards).toHaveCount(library.filter((c) => c.id.startsWith("ch5-") && c.verdict === "ours").length);
  await expect(cards.first().getByRole("columnheader", { name: "open loop" })).toBeVisible();
  await page.getByRole("combobox", { name: "Verdict" }).selectOption("reproduced");
  await expect(cards).toHaveCount(
    library.filter((card) => card.id.startsWith("ch5-") && card.verdict === "reproduced").length,
  );
  await search.fill("seven-step Kalman bank");
  const card = cards.filter({ hasText: "ch5-seven-step" });
  await expect(card.getByText("Not measured yet")).toBeVisible();

  await card.getByRole("button", { name: /headless/ }).click();
  await expect(card.getByText("measured as expected")).toBeVisible({ timeout: 120_000 });
  const drawing = card.getByRole("img", { name: /^Figure of/ });
  await expect.poll(() => drawing.evaluate((img) => (img as HTMLImageElement).naturalWidth)).toBeGreaterThan(0);
  await expect(card.getByRole("row", { name: /correct fraction/ })).toContainText(/≥ 0\.\d+.*0\.9\d+/);
  const report = await page.request.get(await addressOf(card.getByRole("link")));
  expect(await report.text()).toContain("Expectations");
  await seriousViolations(page).then((found) => expect(found).toEqual([]));

  await card.getByRole("button", { name: /live$/ }).click();
  await expect(page.getByRole("button", { name: /^Seven-step/ })).toBeVisible();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await server.ask("DELETE", `/benches/${new URL(page.url()).searchParams.get("bench")}`);
});
