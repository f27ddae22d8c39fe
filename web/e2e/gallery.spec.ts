import { addressOf, expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("the gallery filters, runs an experiment headless, and opens it live", async ({ page, server, openBench }) => {
  await openBench();
  await page.getByRole("navigation", { name: "Pages" }).getByRole("button", { name: "Gallery" }).click();
  const cards = page.getByRole("list", { name: "Experiments" }).locator("> li");
  await expect(cards.first()).toContainText("first-look");
  const { cards: library } = await server.ask<{ cards: { id: string; verdict: string }[] }>("GET", "/gallery");
  await expect(cards).toHaveCount(library.length);

  await page.getByRole("combobox", { name: "Chapter" }).selectOption("5");
  await page.getByRole("combobox", { name: "Verdict" }).selectOption("reproduced");
  await expect(cards).toHaveCount(
    library.filter((card) => card.id.startsWith("ch5-") && card.verdict === "reproduced").length,
  );
  await page.getByRole("searchbox").fill("seven-step Kalman bank");
  const card = cards.filter({ hasText: "ch5-seven-step" });
  await expect(card.getByRole("cell", { name: "–" }).first()).toBeVisible();

  await card.getByRole("button", { name: /headless/ }).click();
  await expect(card.getByText("measured as expected")).toBeVisible({ timeout: 60_000 });
  const drawing = card.getByRole("img", { name: /over the run/ });
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
