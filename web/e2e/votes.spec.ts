import { expect, test } from "./lab";
import { expectClean, SCREENS } from "./screens";
import { seriousViolations } from "./serious-violations";

test("a class votes by one tap, nobody sees what, and the bars lie over the lanes once it is revealed", async ({
  page,
  browser,
  server,
  openBench,
}) => {
  await openBench("lab");
  const group = await server.ask<{ id: string; code: string }>("POST", "/classes", { name: "Tuesday" });
  const context = await browser.newContext({ viewport: SCREENS[3] });
  const phone = await context.newPage();
  await phone.route("**/3d/", (route) => route.fulfill({ contentType: "text/html", body: "" }));
  await phone.goto(`${server.origin}/join`);
  await phone.getByLabel("Code on the wall").fill(group.code);
  await phone.getByLabel("Your name").fill("Ada");
  await phone.getByRole("button", { name: "Join" }).click();
  await expect(phone.getByTestId("bench-state")).toHaveText("running");

  await page.getByTitle(/change bench/).click();
  await page.getByRole("menuitem", { name: /^Fault diagnosis/ }).click();
  const strip = page.getByRole("region", { name: "Lecture", exact: true });
  await expect(strip).toContainText("1 of 10");
  await page.keyboard.press("PageDown");
  await expect(strip).toContainText("2 of 10");
  await expect(strip).toContainText("A: ask by a vote");
  await page.keyboard.press("a");
  await expect(page.getByText("0 of 1 have voted")).toBeVisible();

  const card = phone.getByRole("region", { name: "Vote" });
  await expect(card).toContainText("The plate gets 5 % heavier at 24 ms.");
  await expectClean(phone, "the question on a phone", "[aria-label=Vote]");
  await card.getByRole("button", { name: /^healthy/ }).click();
  await expect(card).toContainText("You can change it");
  await card.getByRole("button", { name: /^mass \+5/ }).click();
  await expect(card.getByRole("button", { name: /^mass \+5/ })).toHaveAttribute("aria-pressed", "true");
  await card.getByRole("slider", { name: "When" }).press("ArrowLeft");
  await expect(page.getByText("1 of 1 have voted")).toBeVisible();
  await expect(page.getByRole("meter")).toHaveCount(0);
  expect(await seriousViolations(phone)).toEqual([]);

  await page.getByRole("button", { name: "Reveal" }).click();
  await expect(page.getByRole("list", { name: "What was said" })).toContainText(/mass \+5.* right.*1\svote/);
  await expect(page.getByRole("img", { name: /1\svote for mass \+5/ })).toBeVisible();
  await expect(card).toContainText(/The right answer: mass \+5/);
  expect(await seriousViolations(page)).toEqual([]);

  await page.getByLabel("Who votes").selectOption({ label: "Hands in the room" });
  await page.getByLabel("Answers", { exact: true }).selectOption({ label: "two to six of my own" });
  await page.getByLabel("One answer in each line").fill("yes\nno");
  await page.getByRole("button", { name: "Open the vote" }).click();
  await page.getByRole("textbox", { name: "no", exact: true }).fill("12");
  await expect(page.getByText(/12\shands counted/)).toBeVisible();
  await page.getByRole("button", { name: "Reveal" }).click();
  await expect(page.getByRole("list", { name: "What was said" })).toContainText(/no12\svotes, 100/);
  await page.getByRole("button", { name: "Another question" }).click();
  await expect(page.getByRole("button", { name: "Open the vote" })).toBeVisible();
  await server.ask("DELETE", `/classes/${group.id}`);
  await context.close();
});
