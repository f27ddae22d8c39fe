import { benchOf, openClass, student } from "./classroom";
import { expect, test } from "./lab";
import { expectClean, SCREENS, showOn } from "./screens";
import { seriousViolations } from "./serious-violations";

test.describe.configure({ timeout: 480_000 });

test("a teacher and a student at one bench: one drives, asks, hands over, takes back; whoever is gone drives no more", async ({
  page,
  browser,
  server,
}) => {
  const group = await openClass(server);
  const ada = await student(browser, server, group, "Ada");
  await expect(ada.getByTitle("Who is here")).toHaveCount(0); // alone she feels nothing
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?bench=${benchOf(ada)}`);
  const theirs = page.getByTitle("Who is here");
  const hers = ada.getByTitle("Who is here");
  await expect(theirs).toHaveText("Ada drives");
  await expect(hers).toHaveText("You drive");
  await expectClean(ada, "two at a bench");

  await page.keyboard.press(" ");
  await expect(page.getByText("Ada drives this bench")).toBeVisible();
  await expect(ada.getByTestId("bench-state")).toHaveText("running");

  await theirs.click();
  await page.getByRole("menuitem", { name: /^Ask to drive/ }).click();
  const asked = ada.getByRole("region", { name: "Class" });
  await expect(asked).toContainText("The teacher asks to drive this bench.");
  await showOn(ada, SCREENS[3]);
  await expectClean(ada, "a student is asked for the bench, on a phone");
  await showOn(ada, SCREENS[0]);
  await asked.getByRole("button", { name: "Hand over" }).click();
  await expect(theirs).toHaveText("You drive");
  await page.getByRole("button", { name: "Pause" }).click();
  await expect(ada.getByTestId("bench-state")).toHaveText("paused");

  await seriousViolations(ada).then((found) => expect(found).toEqual([]));
  await hers.click();
  await expect(ada.getByRole("menuitem").first()).toBeFocused();
  await seriousViolations(ada).then((found) => expect(found).toEqual([]));
  await ada.getByRole("menuitem", { name: "Take the bench back" }).click();
  await expect(theirs).toHaveText("Ada drives");
  await ada.getByRole("button", { name: "Run", exact: true }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("running");

  await ada.close();
  await expect(theirs).toHaveCount(0); // 5 s without her: he is alone, and drives
  await page.getByRole("button", { name: "Pause" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await page.keyboard.press("2");
  await page.getByRole("tab", { name: "Events" }).click();
  await page.getByText("Who did what").click();
  const who = page.getByRole("list", { name: "Who did what, newest first" });
  await expect(who.getByText("was handed the bench by Ada")).toBeVisible();
  await expect(who.getByText("was not heard and drives the bench no longer").first()).toBeVisible();
  await ada.context().close();
  await server.ask("DELETE", `/classes/${group.id}`);
});

test("the teacher lends the own bench to a student, on a phone, who gives it back", async ({
  page,
  openBench,
  browser,
  server,
}) => {
  const group = await openClass(server);
  const ada = await student(browser, server, group, "Ada", SCREENS[3]);
  const own = benchOf(ada);
  await openBench("lab");
  await page.keyboard.press("m");
  await page.getByRole("button", { name: "What can be done with Ada" }).click();
  await page.getByRole("menuitem", { name: "Let Ada drive my bench" }).click();
  await expect.poll(() => benchOf(ada)).toBe(benchOf(page));
  const line = ada.getByRole("region", { name: "Class" });
  await expect(line).toContainText("Your teacher has handed you this bench.");
  await expectClean(ada, "a bench that was handed over, on a phone");
  await ada.getByRole("button", { name: "Stop" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await expect(page.getByTitle("Who is here")).toHaveText("Ada drives");
  await line.getByRole("button", { name: "Give it back" }).click();
  await expect.poll(() => benchOf(ada)).toBe(own);
  await page.keyboard.press(" ");
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await ada.context().close();
  await server.ask("DELETE", `/classes/${group.id}`);
});
