import { expect, test } from "../lab";
import { seriousViolations } from "../serious-violations";

interface Detail {
  results: { id: string; title: string; question: string; rows: { unit: string; digest: string }[] }[];
  cases: number;
  costs: Record<string, { ns_per_sample: number; over_mmae: number }>;
}

test("the benchmark shows each track: its question, its table best first, and its curves", async ({
  page,
  server,
  openBench,
}) => {
  await openBench();
  await page.keyboard.press("u");
  await page.getByRole("tab", { name: "Scores" }).click();
  const { results, costs } = await server.ask<Detail>("GET", "/benchmarks/mems-diag-1");
  for (const track of results) {
    await page.getByRole("combobox", { name: "Track" }).selectOption(track.id);
    await expect(page.getByRole("heading", { name: track.question })).toBeVisible();
    const table = page.getByRole("region", { name: `Results of ${track.title}` });
    const units = () => table.getByRole("rowheader").evaluateAll((all) => all.map((one) => one.getAttribute("title")));
    await expect.poll(units).toEqual(track.rows.map((row) => row.unit));
    await expect(table.getByRole("row").nth(1)).toContainText(track.rows[0]?.digest.slice(0, 8) ?? "nothing");
    const kalman = table.getByRole("row", { name: /Kalman bank \(MMAE\)/ });
    await expect(kalman).toContainText(`${costs.mmae?.ns_per_sample.toFixed(0)} (1.00)`);
  }
  const curves = page.getByRole("region", { name: "Curves" });
  await expect(
    curves.getByRole("img", { name: /^Reliability.*share that was right over probability said/ }),
  ).toBeVisible();
  await expect(curves.getByRole("img", { name: /^Faults found: share found by then over/ })).toBeVisible();
  await expect(curves.getByText("as often right as said")).toBeVisible();
  expect(await seriousViolations(page)).toEqual([]);
});

for (const [name, size] of [
  ["a phone", { width: 390, height: 844 }],
  ["a desk", { width: 1440, height: 900 }],
] as const) {
  test(`the benchmark fits ${name}, in the dark too`, async ({ page, server }) => {
    await page.emulateMedia({ colorScheme: "dark" });
    await page.setViewportSize(size);
    await page.request.get(server.url);
    await page.goto(`${server.origin}/?page=benchmark`);
    await expect(page.getByRole("region", { name: "Curves" })).toBeVisible();
    const wider = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    expect(wider).toBeLessThanOrEqual(0);
    expect(await seriousViolations(page)).toEqual([]);
  });
}
