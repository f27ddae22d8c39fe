import type { Page } from "@playwright/test";
import { expect, test } from "./lab";
import { expectClean, SCREENS, showOn } from "./screens";
import { seriousViolations } from "./serious-violations";

test.describe.configure({ timeout: 480_000 });

const PHONE = SCREENS[3];

const sheet = (page: Page) => page.locator("section[aria-label='Lab sheet']"); // on a wide page its panel is a region of that name too
const points = (page: Page) => page.getByTestId("sheet-points");
const section = (page: Page, heading: string) =>
  sheet(page)
    .getByRole("listitem")
    .filter({ has: page.getByRole("heading", { name: new RegExp(`^${heading}`) }) });

const benchOf = (page: Page) => new URL(page.url()).searchParams.get("bench");

test("a sheet: what is checked, a prediction before the run, wrong answers lose points, the sheet to hand in", async ({
  page,
  openBench,
  server,
}) => {
  page.on("dialog", (dialog) => dialog.accept());
  const command = (order: Record<string, unknown>) => server.ask("POST", `/benches/${benchOf(page)}/commands`, order);
  await openBench("lab");
  await page.keyboard.press("n");
  await page.getByRole("button", { name: "Begin a lab sheet" }).click();
  await page.getByRole("button", { name: /^(Begin|Go on with) First look/ }).click();
  await expect(sheet(page).getByRole("heading", { name: /^First look/ })).toBeVisible();
  await sheet(page).getByRole("button", { name: "Start over…" }).click();
  await expect(points(page)).toContainText("0 of 11");
  await expect(sheet(page).locator(".katex").first()).toBeVisible();

  // the first step closes itself, once time has run
  await expect(section(page, "Let it run")).toContainText("(wanted: 100 nm to 20 µm)");
  await command({ kind: "time_scale", value: null });
  await command({ kind: "start" });
  await expect(points(page)).toContainText("1 of 11");

  // an answer that cannot be read costs nothing, a wrong one does, partly right ones say why
  const amplitude = section(page, "Read the amplitude");
  const field = amplitude.getByRole("textbox");
  await field.fill("about two");
  await amplitude.getByRole("button", { name: "Answer", exact: true }).click();
  await expect(amplitude).toContainText("begins with no number");
  await expect(points(page)).toContainText("1 of 11");
  await field.fill("999 um");
  await field.press("Enter");
  await expect(amplitude.getByRole("list", { name: "Answers" })).toContainText("wrong");
  await expect(points(page)).toContainText("0.5 of 11");
  await amplitude.getByRole("button", { name: "Hint, costs 0.25" }).click();
  await expect(amplitude).toContainText("Half of the distance");
  await amplitude.getByRole("button", { name: "Go on without it" }).click();
  await expect(amplitude).toContainText("Right answer:");

  // the run stays closed until the prediction is there; then it cannot be changed
  const run = section(page, "Run: 5 % more mass");
  await expect(run).toContainText("closed until");
  const guess = section(page, "Predict: a heavier plate");
  await guess.getByRole("radio", { name: "It shrinks" }).check();
  await guess.getByRole("button", { name: "Commit the prediction" }).click();
  await expect(guess).toContainText("committed; judged after the run");
  await expect(guess.getByRole("radio")).toHaveCount(0);
  await command({ fault: "added_mass", severity: 0.05 });
  await expect(run).toHaveAttribute("data-state", "done");
  await expect(guess).toContainText("wrong: a heavier plate");

  // a recording is handed in with the sheet
  await server.ask("POST", `/benches/${benchOf(page)}/recordings`, { ticks: 0, past_ticks: 100, name: "heavier" });
  await sheet(page).getByRole("button", { name: "Add a recording…" }).click();
  await page.getByRole("menuitem", { name: /^heavier, 1/ }).click();
  await expect(sheet(page).getByRole("list", { name: "Recordings handed in" })).toContainText("heavier, 1");

  await seriousViolations(page).then((found) => expect(found).toEqual([]));
  const report = await page.request.get(`${server.origin}/api/v1/sheets/first-look/report`);
  const html = await report.text();
  expect(html).toContain("999 um");
  expect(html).toContain("<math");
  expect(html).toContain("Recordings handed in");
  expect(html).not.toMatch(/<script|https?:\/\/(?!www\.w3\.org)/);

  await showOn(page, PHONE);
  await expect(sheet(page)).toBeVisible();
  await expectClean(page, "a sheet on a phone");
  await page.getByRole("radiogroup", { name: "What is shown" }).getByText("Bench").click();
  await expect(page.getByRole("region", { name: /^Scope/ }).first()).toBeVisible();
  await command({ kind: "pause" });
});

test("a teacher begins a sheet for the class: it opens beside a new bench, and the tile says how far", async ({
  page,
  browser,
  server,
}) => {
  page.on("dialog", (dialog) => dialog.accept());
  await page.request.get(server.url);
  const group = await server.ask<{ id: string; code: string }>("POST", "/classes", { name: "Wednesday" });
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
  const student = await context.newPage();
  await student.route("**/3d/", (route) => route.fulfill({ contentType: "text/html", body: "" }));
  await student.goto(`${server.origin}/join`);
  await student.getByLabel("Code on the wall").fill(group.code);
  await student.getByLabel("Your name").fill("Ada");
  await student.getByRole("button", { name: "Join" }).click();
  await expect(student.getByTestId("bench-state")).toHaveText("running");

  await page.goto(`${server.origin}/?page=class`);
  const all = page.getByRole("region", { name: "For all benches" });
  await all.getByLabel("Lab sheet", { exact: true }).selectOption("resonance-and-q");
  await all.getByRole("button", { name: "Begin sheet on all" }).click();
  await expect(student.getByText("You have a new bench")).toBeVisible();
  await expect(sheet(student).getByRole("heading", { name: /^Resonance and Q/ })).toBeVisible();
  await sheet(student).getByRole("button", { name: "Go on without it" }).click();
  await expect(page.getByRole("listitem", { name: "Ada", exact: true })).toContainText("step 2 of 10, 0 of 18 points");
  await section(student, "The gain at rest").getByRole("textbox").fill("99 V");
  await student.keyboard.press("Enter");
  await expect(page.getByRole("listitem", { name: "Ada", exact: true })).toContainText("−0.5 of 18 points");
  await expect(sheet(student).getByRole("button", { name: "Start over…" })).toHaveCount(0);
  await server.ask("DELETE", `/classes/${group.id}`);
  await context.close();
});
