import { benchOf } from "./classroom";
import { expect, test } from "./lab";

test("a lecture is run by keys, forwards and back with the same bits, and leaves all as it was", async ({
  page,
  openBench,
  server,
  context,
}) => {
  const stateOf = async (bench: string) => (await server.ask<{ state: string }>("GET", `/benches/${bench}`)).state;
  const digestOf = (bench: string) => server.ask<{ tick: number; digest: string }>("GET", `/benches/${bench}/digest`);
  const strip = page.getByRole("region", { name: "Lecture", exact: true });
  const notes = page.getByRole("region", { name: "Notes of the speaker" });
  const tabs = () => page.getByRole("tab").allInnerTexts();
  await openBench("lab");
  const before = benchOf(page);
  const panels = await tabs();
  await page.getByTitle(/change bench/).click();
  await page.getByRole("menuitem", { name: /^Fault diagnosis/ }).click();
  await expect(strip).toContainText("1 of 10Six filters listen");
  await expect(page.locator("html")).toHaveAttribute("data-size", "large");
  await expect(notes).toBeHidden();
  await expect.poll(() => stateOf(before)).toBe("paused");

  const stage = benchOf(page);
  expect(stage).not.toBe(before);
  await page.keyboard.press("Space");
  await expect(strip).toContainText("2 of 10Vote");
  await page.keyboard.press("ArrowRight");
  await expect(strip).toContainText("3 of 10");
  await page.keyboard.press("PageDown");
  await expect(strip).toContainText("4 of 10Why?");
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await expect(page.getByRole("tab", { name: "Why", exact: true })).toHaveAttribute("aria-selected", "true");
  const there = await digestOf(stage);
  await page.keyboard.press("PageDown");
  await expect(strip).toContainText("5 of 10");
  await server.advance(1);
  await page.keyboard.press("h");
  await page.keyboard.press("PageUp");
  await expect(strip).toContainText("4 of 10");
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  expect(await digestOf(stage)).toEqual(there);
  expect(benchOf(page)).toBe(stage);

  const [window] = await Promise.all([context.waitForEvent("page"), page.keyboard.press("i")]);
  await expect(window.getByRole("heading", { level: 1 })).toHaveText("4 of 10 Why?");
  await expect(window.getByRole("region", { name: "Notes of the speaker" })).toContainText(
    "click the lane where it turns",
  );
  await window.keyboard.press("PageDown");
  await expect(window.getByRole("heading", { level: 1 })).toContainText("5 of 10");
  await expect(strip).toContainText("5 of 10");
  await window.close();

  await page.bringToFront();
  const rail = page.getByRole("navigation", { name: "Pages" });
  await page.keyboard.press("p");
  await expect(strip).toHaveText("Heavier still, then a stiffer spring5 of 10");
  await expect(rail).toBeHidden();
  await expect(page.getByRole("timer")).toHaveCount(0);
  await expect(page.getByRole("region", { name: "Timeline" })).toBeHidden();
  await expect(page.getByRole("tab", { name: "Faults" })).toHaveCount(0);
  await page.reload();
  await expect(strip).toHaveText("Heavier still, then a stiffer spring5 of 10");
  await page.keyboard.press("Escape");
  await expect(rail).toBeVisible();
  await strip.getByRole("button", { name: "Leave" }).click();
  await expect(strip).toHaveCount(0);
  await expect.poll(() => benchOf(page)).toBe(before);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await expect.poll(tabs).toEqual(panels);
  await expect(page.locator("html")).toHaveAttribute("data-size", "normal");
  await expect.poll(async () => (await server.ask<{ benches: object[] }>("GET", "/benches")).benches.length).toBe(1);
});
