import type { Browser, Page } from "@playwright/test";
import { expect, test } from "./lab";
import type { LabServer } from "./lab-server";
import { expectClean, expectFits, SCREENS, type Screen, showOn } from "./screens";
import { seriousViolations } from "./serious-violations";

test.describe.configure({ timeout: 480_000 });

const PHONE = SCREENS[3];

/** The page of somebody else, without the 3D view. */
async function somebody(browser: Browser, viewport = { width: 1440, height: 900 }): Promise<Page> {
  const context = await browser.newContext({ viewport });
  const page = await context.newPage();
  await page.route("**/3d/", (route) => route.fulfill({ contentType: "text/html", body: "" }));
  return page;
}

/** A student who has joined by the form. */
async function student(
  browser: Browser,
  server: LabServer,
  code: string,
  name: string,
  screen?: Screen,
): Promise<Page> {
  const page = await somebody(browser, screen);
  await page.goto(`${server.origin}/join`);
  await page.getByLabel("Code on the wall").fill(code);
  await page.getByLabel("Your name").fill(name);
  await page.getByRole("button", { name: "Join" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  return page;
}

const benchOf = (page: Page) => new URL(page.url()).searchParams.get("bench");

test("a class from its code to its end: benches of their own, the grid, what is done for all", async ({
  page,
  browser,
  server,
}) => {
  page.on("dialog", (dialog) => dialog.accept());
  await page.goto(server.url);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await page.keyboard.press("m");
  await page.getByLabel("Name of the class").fill("Tuesday");
  await page.getByRole("button", { name: "Open the class" }).click();
  const code = await page.getByLabel("Join code").innerText();
  await expect(page.getByRole("img", { name: /^QR code of .*\/join\?code=/ })).toBeVisible();
  await page.getByRole("button", { name: "Show on the wall" }).click();
  await expect(page.getByRole("dialog", { name: "Tuesday" })).toContainText(code);
  await page.keyboard.press("Escape");
  await expect(page.getByRole("dialog")).toHaveCount(0);

  const [ada, emmy] = await Promise.all([
    student(browser, server, code, "Ada"),
    student(browser, server, code, "Emmy", PHONE),
  ]);
  expect(benchOf(ada)).not.toBe(benchOf(emmy));
  const tile = (name: string) => page.getByRole("listitem", { name, exact: true });
  const all = page.getByRole("region", { name: "For all benches" });
  const pages = ada.getByRole("navigation", { name: "Pages" });
  await expect(pages.getByRole("button", { name: "Gallery" })).toBeVisible();
  for (const name of ["Runs", "Class"]) await expect(pages.getByRole("button", { name })).toHaveCount(0);
  for (const name of [/^Fork/, /^Share/]) await expect(ada.getByRole("button", { name })).toHaveCount(0);

  await ada.getByRole("button", { name: /^Inject .* Added mass$/ }).click();
  await expect(tile("Ada").getByText(/^Added mass/)).toBeVisible();
  await expect(tile("Emmy").getByText("no fault")).toBeVisible();
  await emmy.getByRole("button", { name: "Raise hand" }).click();
  await expect(tile("Emmy").getByRole("button", { name: "Lower the hand of Emmy" })).toBeVisible();
  await expect(page.getByRole("region", { name: "Students" }).getByRole("listitem").first()).toContainText("Emmy");

  await all.getByRole("button", { name: "Freeze" }).click();
  await expect(all.getByText("Freeze: 2 done.")).toBeVisible();
  for (const one of [ada, emmy]) await expect(one.getByTestId("bench-state")).toHaveText("paused");
  await page.getByRole("checkbox", { name: "Choose Emmy" }).check();
  await all.getByRole("button", { name: "Release" }).click();
  await expect(emmy.getByTestId("bench-state")).toHaveText("running");
  await expect(ada.getByTestId("bench-state")).toHaveText("paused");
  await all.getByRole("button", { name: "Choose none" }).click();

  await seriousViolations(page).then((found) => expect(found).toEqual([]));
  await expectFits(page, "the page of a class");
  await expectClean(emmy, "the page of a student on a phone");

  const before = benchOf(ada);
  await all.getByLabel("Scenario", { exact: true }).selectOption("ch5-seven-step");
  await all.getByRole("button", { name: "Begin on all" }).click();
  // a notice goes by itself, so both are looked for at once
  await Promise.all([ada, emmy].map((one) => expect(one.getByText("You have a new bench")).toBeVisible()));
  for (const one of [ada, emmy]) {
    await expect(one.getByTestId("bench-state")).toHaveText("running");
    await expect(one.getByRole("region", { name: "Steps of the scenario" })).toBeVisible();
  }
  expect(benchOf(ada)).not.toBe(before);

  await tile("Ada").getByRole("button", { name: "Ada", exact: true }).click();
  await expect.poll(() => benchOf(page)).toBe(benchOf(ada));
  await expect(page.getByText("2 watching")).toBeVisible();
  await page.goBack();
  await expect(tile("Ada")).toBeVisible();

  const { classes } = await server.ask<{ classes: { id: string }[] }>("GET", "/classes");
  await server.ask("POST", `/classes/${classes[0].id}/commands`, { command: { make_safe: "to be tried" } });
  await expect(ada.getByTestId("bench-state")).toHaveText("tripped");
  await all.getByRole("button", { name: "Reset 2 trips" }).click();
  await expect(all.getByText("Reset trips: 2 done.")).toBeVisible();
  await expect(ada.getByTestId("bench-state")).toHaveText("paused");
  await expect(all.getByRole("button", { name: /^Reset/ })).toHaveCount(0);

  await page.getByRole("button", { name: "What was done" }).click();
  const log = page.getByRole("list", { name: "What was done, newest first" });
  await expect(log.getByText("began a scenario on all benches")).toBeVisible();
  await expect(log.getByRole("listitem").filter({ hasText: "Ada" }).first()).toContainText(/tick|joined/);
  await page.keyboard.press("Escape");

  await tile("Emmy").getByRole("button", { name: "What can be done with Emmy" }).click();
  await page.getByRole("menuitem", { name: "Send away…" }).click();
  await expect(emmy.getByText("Your session has ended")).toBeVisible();
  await expect(emmy.getByRole("link", { name: "Join a class" })).toHaveAttribute("href", "./join");
  await expect(tile("Emmy")).toHaveCount(0);
  await page.getByRole("button", { name: "End the class…" }).click();
  await expect(page.getByLabel("Name of the class")).toBeVisible();
  await expect(ada.getByText("Your session has ended")).toBeVisible();
  await Promise.all([ada, emmy].map((one) => one.context().close()));
});

test("a link to watch shows a bench and lets nobody command it, until it ends", async ({
  page,
  openBench,
  browser,
}) => {
  await openBench("lab");
  await page.getByRole("button", { name: "Share this experiment" }).click();
  await page.getByRole("button", { name: "Make a link" }).click();
  const address = await page.getByRole("textbox", { name: "Address to watch" }).inputValue();
  const guest = await somebody(browser);
  const sent: string[] = [];
  guest.on("websocket", (socket) => socket.on("framesent", ({ payload }) => sent.push(String(payload))));
  await guest.goto(address);
  await expect(guest.getByTestId("bench-state")).toHaveText("running");
  await expect(guest.getByText("You watch this bench").first()).toBeVisible();
  for (const name of ["Pause", "Reset", /^Record/]) await expect(guest.getByRole("button", { name })).toHaveCount(0);
  await expect(guest.getByRole("button", { name: /^Inject/ })).toHaveCount(0);
  for (const key of [" ", "h", "c", "R"]) await guest.keyboard.press(key);
  await guest.keyboard.press("2");
  await expect(guest.getByRole("region", { name: /^Scope/ }).first()).toBeVisible();
  expect(sent.filter((text) => text.includes('"command"'))).toEqual([]);
  await seriousViolations(guest).then((found) => expect(found).toEqual([]));
  await showOn(guest, PHONE);
  await expectClean(guest, "a bench that is watched, on a phone");
  await page.getByRole("list", { name: "Links to watch this bench" }).getByRole("button", { name: "End" }).click();
  await expect(guest.getByText("The link to watch has ended")).toBeVisible();
  await guest.context().close();
});
