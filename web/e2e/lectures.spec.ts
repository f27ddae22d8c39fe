import type { Page } from "@playwright/test";
import { expect, test } from "./lab";
import type { LabServer } from "./lab-server";
import { expectClean } from "./screens";
import { seriousViolations } from "./serious-violations";

const benchOf = (page: Page) => new URL(page.url()).searchParams.get("bench") ?? "";
const strip = (page: Page) => page.getByRole("region", { name: "Lecture", exact: true });
const notes = (page: Page) => page.getByRole("region", { name: "Notes of the speaker" });
const digestOf = (server: LabServer, bench: string) =>
  server.ask<{ tick: number; digest: string }>("GET", `/benches/${bench}/digest`);

test("a lecture is run by keys, forwards and back with the same bits, and leaves all as it was", async ({
  page,
  openBench,
  server,
  context,
}) => {
  await openBench("lab");
  const before = benchOf(page);
  const tabs = () => page.getByRole("tab").allInnerTexts();
  const panels = await tabs();
  await page.getByTitle(/change bench/).click();
  await page.getByRole("menuitem", { name: /^Fault diagnosis/ }).click();
  await expect(strip(page)).toContainText("1 of 10Six filters listen");
  await expect(page.locator("html")).toHaveAttribute("data-size", "large");
  await expect(notes(page)).toContainText("six Kalman filters watch");
  await expect(strip(page)).toContainText("Space, → or a clicker: next cue");
  expect(benchOf(page)).not.toBe(before);
  expect((await server.ask<{ state: string }>("GET", `/benches/${before}`)).state).toBe("paused");

  const stage = benchOf(page);
  await page.keyboard.press("Space");
  await expect(strip(page)).toContainText("2 of 10Vote");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("PageDown");
  await expect(strip(page)).toContainText("4 of 10Why?");
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await expect(page.getByRole("tab", { name: "Why", exact: true })).toHaveAttribute("aria-selected", "true");
  const there = await digestOf(server, stage);
  await page.keyboard.press("PageDown");
  await expect(strip(page)).toContainText("5 of 10");
  await page.keyboard.press("h");
  await page.keyboard.press("PageUp");
  await expect(strip(page)).toContainText("4 of 10");
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  expect(await digestOf(server, stage)).toEqual(there);
  expect(benchOf(page)).toBe(stage);
  expect(await seriousViolations(page)).toEqual([]);

  const [window] = await Promise.all([
    context.waitForEvent("page"),
    page.getByRole("button", { name: "Notes in a window of their own" }).click(),
  ]);
  await expect(window.getByRole("heading", { level: 1 })).toHaveText("4 of 10 Why?");
  await expect(notes(page)).toBeHidden();
  await window.keyboard.press("PageDown");
  await expect(window.getByRole("heading", { level: 1 })).toContainText("5 of 10");
  await expect(strip(page)).toContainText("5 of 10");
  await window.close();

  await page.bringToFront();
  await page.keyboard.press("p");
  await expect(strip(page)).toHaveText("Heavier still, then a stiffer spring5 of 10");
  await page.keyboard.press("Escape");
  await page.reload();
  await expect(strip(page)).toContainText("5 of 10");
  await strip(page).getByRole("button", { name: "Leave" }).click();
  await expect(strip(page)).toHaveCount(0);
  await expect.poll(() => benchOf(page)).toBe(before);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await expect.poll(tabs).toEqual(panels);
  await expect(page.locator("html")).toHaveAttribute("data-size", "normal");
  await page.keyboard.press("Space");
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await expect.poll(async () => (await server.ask<{ benches: object[] }>("GET", "/benches")).benches.length).toBe(1);
});

test("every lecture begins from the gallery and comes to its last cue", async ({ page, openBench, server }) => {
  const { lectures } = await server.ask<{ lectures: { id: string; title: string; cues: number }[] }>(
    "GET",
    "/lectures",
  );
  await openBench("lab");
  const before = benchOf(page);
  for (const [i, { title, cues }] of lectures.entries()) {
    if (i === 0) await page.keyboard.press("e"); // leaving comes back to the gallery
    await page.getByText(/^5\slectures with notes/).click();
    await page.getByRole("button", { name: `Start ${title}` }).click();
    await expect(strip(page)).toContainText(`1 of ${cues}`);
    await page.getByRole("button", { name: "All cues" }).click();
    await page.getByRole("menuitem").last().click();
    await expect(strip(page)).toContainText(`${cues} of ${cues}`);
    await expect(page.locator(".mantine-Notification-root")).toHaveCount(0);
    if (i === 0) await expectClean(page, "a lecture", "[aria-label=Lecture]");
    await strip(page).getByRole("button", { name: "Leave" }).click();
    await expect(strip(page)).toHaveCount(0);
  }
  expect(benchOf(page)).toBe(before);
});
