import type { Page } from "@playwright/test";
import { benchOf, expect, test } from "./classroom";

const sheet = (page: Page) => page.locator("section[aria-label='Lab sheet']"); // its panel is a region of the same name
const step = (page: Page, heading: string) =>
  sheet(page)
    .getByRole("listitem")
    .filter({ has: page.getByRole("heading", { name: new RegExp(`^${heading}`) }) });

test("a student works through a lab sheet and hands it in, and the tile of the teacher shows the points", async ({
  page,
  server,
  student,
}) => {
  page.on("dialog", (dialog) => dialog.accept());
  const ada = await student("Ada");
  const before = benchOf(ada);
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?page=class`);
  const all = page.getByRole("region", { name: "For all benches" });
  await all.getByLabel("Lab sheet", { exact: true }).selectOption("first-look");
  await all.getByRole("button", { name: "Begin sheet on all" }).click();
  const tile = page.getByRole("listitem", { name: "Ada", exact: true });
  const points = ada.getByTestId("sheet-points");
  await expect(sheet(ada).getByRole("heading", { name: /^First look/ })).toBeVisible();
  await expect(points).toContainText("0 of 11");
  await expect(sheet(ada).locator(".katex").first()).toBeVisible();
  await expect(sheet(ada).getByRole("button", { name: "Start over…" })).toHaveCount(0);
  await expect.poll(() => benchOf(ada)).not.toBe(before);
  const bench = benchOf(ada);

  // a step checks itself once time has run
  await expect(step(ada, "Let it run")).toContainText("(wanted: 100 nm to 20 µm)");
  await expect(ada.getByTestId("bench-state")).toHaveText("running");
  await server.advanceTicks(bench, 1500);
  await expect(points).toContainText("1 of 11");
  await expect(tile).toContainText("step 2 of");

  // an unreadable answer costs nothing, a wrong answer costs points
  const amplitude = step(ada, "Read the amplitude");
  const field = amplitude.getByRole("textbox");
  await field.fill("about two");
  await amplitude.getByRole("button", { name: "Answer", exact: true }).click();
  await expect(amplitude).toContainText("begins with no number");
  await expect(points).toContainText("1 of 11");
  await field.fill("31 um"); // beyond all amplitudes of this step, in nm and in mm too: its device is drawn
  await field.press("Enter");
  await expect(amplitude.getByRole("list", { name: "Answers" })).toContainText("wrong");
  await expect(points).toContainText("0.5 of 11");
  await expect(tile).toContainText("0.5 of 11 points");
  await amplitude.getByRole("button", { name: "Hint, costs 0.25" }).click();
  await expect(amplitude).toContainText("Half of the distance");
  await amplitude.getByRole("button", { name: "Skip this question" }).click();
  await expect(amplitude).toContainText("Right answer:");

  // the run is closed until the prediction is committed, which is judged after the run
  const run = step(ada, "Run: 5 % more mass");
  await expect(run).toContainText("Complete the previous steps first");
  const guess = step(ada, "Predict: a heavier plate");
  await guess.getByRole("radio", { name: "It shrinks" }).check();
  await guess.getByRole("button", { name: "Commit the prediction" }).click();
  await expect(guess).toContainText("committed; judged after the run");
  await expect(guess.getByRole("radio")).toHaveCount(0);
  await server.ask("POST", `/benches/${bench}/commands`, { fault: "added_mass", severity: 0.05 });
  await server.advanceTicks(bench, 1500);
  await expect(run).toHaveAttribute("data-state", "done");
  await expect(guess).toContainText("wrong: a heavier plate");

  const headers = { origin: server.origin };
  const data = { ticks: 0, past_ticks: 100, name: "heavier" };
  const recorded = await ada.request.post(`${server.origin}/api/v1/benches/${bench}/recordings`, { headers, data });
  expect(recorded.ok()).toBe(true);
  await sheet(ada).getByRole("button", { name: "Add a recording…" }).click();
  await ada.getByRole("menuitem", { name: /^heavier, 1/ }).click();
  await expect(sheet(ada).getByRole("list", { name: "Recordings handed in" })).toContainText("heavier, 1");
  const report = await ada.request.get(`${server.origin}/api/v1/sheets/first-look/report`);
  const html = await report.text();
  for (const part of ["31 um", "<math", "Recordings handed in"]) expect(html).toContain(part);
  expect(html).not.toMatch(/<script|https?:\/\/(?!www\.w3\.org)/);
});
