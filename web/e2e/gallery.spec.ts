import { addressOf, expect, test } from "./lab";
import { LabServer } from "./lab-server";

interface Library {
  cards: { id: string; verdict: string }[];
}

test("figures are made when the gallery is opened; it searches, runs an experiment headless, and opens it live", async ({
  page,
}) => {
  const server = await LabServer.create({ COMBBENCH_FIGURES: "true" });
  try {
    await page.request.get(server.url);
    await page.goto(`${server.origin}/gallery/ch5-seven-step`);
    const cards = page.getByRole("list", { name: "Experiments" }).locator("> li");
    await expect(cards).toHaveCount(1);
    await expect(page).toHaveTitle(/^Seven-step .* \| Gallery \| CombBench$/);
    await page.getByRole("button", { name: "All experiments" }).click();
    await expect(page).toHaveTitle("Gallery | CombBench");
    await page.goBack();
    await expect(cards).toHaveCount(1);
    await page.goForward();
    const { cards: library } = await server.ask<Library>("GET", "/gallery");
    await expect(cards).toHaveCount(library.length);
    const figure = cards.nth(0).getByRole("img", { name: /^Figure of First look/ });
    await expect(figure).toBeVisible();
    await expect.poll(() => figure.evaluate((img) => (img as HTMLImageElement).naturalWidth)).toBeGreaterThan(0);
    const svg = await page.request.get(`${server.origin}/api/v1/gallery/first-look/figure`);
    expect(await svg.text()).toMatch(/time, ms<.*displacement, µm/);

    const search = page.getByRole("searchbox");
    await search.fill("broken truss");
    await expect(cards.first()).toContainText("ch3-case2-broken-truss");
    await search.fill("no such thing");
    await page.getByRole("button", { name: "Show all" }).click();
    await expect(cards).toHaveCount(library.length);
    await page.getByRole("combobox", { name: "Chapter" }).selectOption("5");
    await page.getByRole("combobox", { name: "Verdict" }).selectOption("reproduced by tuning");
    const wanted = library.filter(({ id, verdict }) => id.startsWith("ch5-") && verdict === "reproduced by tuning");
    await expect(cards).toHaveCount(wanted.length);
    await search.fill("seven-step Kalman bank");
    const card = cards.filter({ hasText: "ch5-seven-step" });
    await card.getByRole("button", { name: /headless/ }).click();
    await expect(card.getByText("measured as expected")).toBeVisible();
    await expect(card.getByRole("row", { name: /correct fraction/ })).toContainText(/≥\s0\.\d+.*0\.9\d+/);
    const report = await page.request.get(await addressOf(card.getByRole("link", { name: /^Report/ })));
    expect(await report.text()).toContain("Expectations");
    await card.getByRole("button", { name: /live$/ }).click();
    await expect(page.getByRole("button", { name: /^Seven-step/ })).toBeVisible();
    await expect(page.getByTestId("bench-state")).toHaveText("running");
  } finally {
    await server.destroy();
  }
});
