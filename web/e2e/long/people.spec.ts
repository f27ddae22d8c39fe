import { benchOf, classLine, expect, PHONE, test } from "../classroom";
import { chooseMore } from "../lab";
import { LabServer } from "../lab-server";
import { expectClean, expectFits, showOn } from "../screens";
import { seriousViolations } from "../serious-violations";

test("the pages of a visitor and of a full server fit every screen", async ({ page, server }) => {
  await page.goto(server.origin);
  await expect(page.getByText("Ask the person who runs it")).toBeVisible();
  expect(await seriousViolations(page)).toEqual([]);
  await expectFits(page, "the page of a visitor");
  await page.getByLabel("Access token").fill("guessed");
  await page.getByRole("button", { name: "Open" }).click();
  await expect(page.getByRole("alert")).toBeVisible();
  await expectFits(page, "a wrong token");
  const small = await LabServer.create({ COMBBENCH_MAX_BENCHES: "1" });
  try {
    await small.ask("POST", "/benches", { scenario: "first-look", keep: true });
    await page.goto(small.url);
    await expect(page.getByRole("heading", { name: "This server has no free bench" })).toBeVisible();
    expect(await seriousViolations(page)).toEqual([]);
    await expectFits(page, "a full server");
  } finally {
    await small.destroy();
  }
});

test("the page of a class and the pages of its students fit their screens", async ({ page, server, student }) => {
  page.on("dialog", (dialog) => dialog.accept());
  const [ada, emmy] = await Promise.all([student("Ada"), student("Emmy", PHONE)]);
  await page.goto(server.url);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await page.keyboard.press("m");
  await expect(page.getByRole("listitem", { name: "Emmy", exact: true })).toBeVisible();
  expect(await seriousViolations(page)).toEqual([]);
  await expectFits(page, "the page of a class");
  await expectClean(emmy, "a student on a phone");

  await page.getByRole("button", { name: "Show my bench to all" }).click();
  for (const one of [ada, emmy]) await expect(classLine(one)).toContainText("Your teacher shows this bench to all.");
  await expectClean(ada, "a bench that is shown to all");
  await expectClean(emmy, "a bench that is shown to all, on a phone");
  expect(await seriousViolations(emmy)).toEqual([]);
  await page.keyboard.press("m");
  await page.getByTitle("Who is here").click();
  await expect(page.getByRole("dialog")).toContainText("look on");
  expect(await seriousViolations(page)).toEqual([]);
  await page.keyboard.press("Escape");
  await classLine(page).getByRole("button", { name: "End showing" }).click();
  await expect(classLine(emmy)).toHaveCount(0);

  await page.keyboard.press("m");
  await page.getByRole("button", { name: "Set hidden faults" }).click();
  await expect(emmy.getByText("A fault is hidden here, or none")).toBeVisible();
  expect(await seriousViolations(page)).toEqual([]);
  await expectFits(emmy, "a student with a hidden fault");
});

test("the pages of people who share a bench fit their screens", async ({
  page,
  server,
  openBench,
  student,
  elsewhere,
}) => {
  const ada = await student("Ada");
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?bench=${benchOf(ada)}`);
  const theirs = page.getByTitle("Who is here");
  await expect(theirs).toHaveText("Ada drives");
  await expectClean(ada, "two at a bench");
  await theirs.click();
  await page.getByRole("menuitem", { name: /^Ask to drive/ }).click();
  await expect(classLine(ada)).toContainText("The teacher asks to drive this bench.");
  await showOn(ada, PHONE);
  await expectClean(ada, "a student is asked for the bench, on a phone");
  expect(await seriousViolations(ada)).toEqual([]);

  await openBench("lab");
  await page.keyboard.press("m");
  await page.getByRole("button", { name: "What can be done with Ada" }).click();
  await page.getByRole("menuitem", { name: "Let Ada drive my bench" }).click();
  await expect(classLine(ada)).toContainText("Your teacher has handed you this bench.");
  await expectClean(ada, "a bench that was handed over, on a phone");

  await chooseMore(page, /^Share this experiment/);
  await expect(page.getByRole("img", { name: /^QR code of/ })).toBeVisible();
  expect(await seriousViolations(page)).toEqual([]);
  await page.getByRole("button", { name: "Let people watch" }).click();
  await expect(page.getByText("All others watch this bench live")).toBeVisible();
  const guest = await elsewhere();
  await guest.goto(await page.getByRole("textbox", { name: "Link", exact: true }).inputValue());
  await expect(guest.getByText("You watch this bench").first()).toBeVisible();
  expect(await seriousViolations(guest)).toEqual([]);
  await showOn(guest, PHONE);
  await expectClean(guest, "a bench that is watched, on a phone");
});

test("votes and lab sheets fit a phone, and axe finds nothing serious in them", async ({
  page,
  server,
  openBench,
  group,
  student,
}) => {
  const emmy = await student("Emmy", PHONE);
  await openBench("lab");
  const question = { class_id: group.id, text: "What comes next?", answers: ["nothing", "a fault"] };
  const { id } = await server.ask<{ id: string }>("POST", "/votes", question);
  const card = emmy.getByRole("region", { name: "Vote" });
  await expect(card).toContainText("What comes next?");
  await expectClean(emmy, "the question on a phone", "[aria-label=Vote]");
  await card.getByRole("button", { name: "a fault" }).click();
  await expect(card).toContainText("You can change it");
  expect(await seriousViolations(emmy)).toEqual([]);
  await server.ask("POST", `/votes/${id}/reveal`);
  await expect(card.getByRole("button", { name: /1\svote/ })).toBeVisible();
  expect(await seriousViolations(emmy)).toEqual([]);

  await page.keyboard.press("n");
  await page.getByRole("button", { name: "Begin a lab sheet" }).click();
  await page.getByRole("button", { name: /^(Begin|Go on with) First look/ }).click();
  const sheet = page.locator("section[aria-label='Lab sheet']");
  await expect(sheet.getByRole("heading", { name: /^First look/ })).toBeVisible();
  expect(await seriousViolations(page)).toEqual([]);
  await showOn(page, PHONE);
  await expect(sheet).toBeVisible();
  await expectClean(page, "a sheet on a phone");
  await expect(page.getByRole("region", { name: /^Scope/ })).toBeInViewport();
});
