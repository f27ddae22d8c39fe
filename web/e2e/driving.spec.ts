import { benchOf, classLine, expect, PHONE, test } from "./classroom";
import { front } from "./lab";

test("one person drives a bench: asks, hands over, takes back, and drives no more when gone", async ({
  page,
  server,
  student,
}) => {
  const ada = await student("Ada");
  const bench = benchOf(ada);
  await expect(ada.getByTitle("Who is here")).toHaveCount(0); // alone at her bench
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?bench=${bench}&layout=lab`);
  const theirs = page.getByTitle("Who is here");
  const hers = ada.getByTitle("Who is here");
  await expect(theirs).toHaveText("Ada drives");
  await expect(hers).toHaveText("You drive");
  await page.keyboard.press(" ");
  await expect(page.getByText("Ada drives this bench")).toBeVisible();
  await expect(ada.getByTestId("bench-state")).toHaveText("running");

  await theirs.click();
  await page.getByRole("menuitem", { name: /^Ask to drive/ }).click();
  await expect(classLine(ada)).toContainText("The teacher asks to drive this bench.");
  await classLine(ada).getByRole("button", { name: "Hand over" }).click();
  await expect(theirs).toHaveText("You drive");
  await page.getByRole("button", { name: "Pause" }).click();
  await expect(ada.getByTestId("bench-state")).toHaveText("paused");
  await hers.click();
  await expect(ada.getByRole("menuitem").first()).toBeFocused();
  await ada.getByRole("menuitem", { name: "Take the bench back" }).click();
  await expect(theirs).toHaveText("Ada drives");

  await ada.close();
  const watchers = () => server.ask<{ watchers: number }>("GET", `/benches/${bench}`).then((one) => one.watchers);
  await expect.poll(watchers).toBe(1);
  await server.advance(6); // without an answer of the driver the lease lasts 5 s
  await expect(theirs).toHaveCount(0);
  await page.getByRole("button", { name: "Run", exact: true }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await front(page, "Log", "Events");
  await page.getByText("Who did what").click();
  const who = page.getByRole("list", { name: "Who did what, newest first" });
  await expect(who.getByText("was handed the bench by Ada")).toBeVisible();
  await expect(who.getByText("was not heard and drives the bench no longer").first()).toBeVisible();
});

test("a teacher lends a bench to a student on a phone, who gives it back", async ({ page, openBench, student }) => {
  const ada = await student("Ada", PHONE);
  const own = benchOf(ada);
  await openBench("lab");
  await page.keyboard.press("m");
  await page.getByRole("button", { name: "What can be done with Ada" }).click();
  await page.getByRole("menuitem", { name: "Let Ada drive my bench" }).click();
  await expect.poll(() => benchOf(ada)).toBe(benchOf(page));
  await expect(classLine(ada)).toContainText("Your teacher has handed you this bench.");
  await ada.getByRole("button", { name: "Stop" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await expect(page.getByTitle("Who is here")).toHaveText("Ada drives");
  await classLine(ada).getByRole("button", { name: "Give it back" }).click();
  await expect.poll(() => benchOf(ada)).toBe(own);
  await expect(page.getByTitle("Who is here")).toHaveCount(0);
  await page.keyboard.press(" ");
  await expect(page.getByTestId("bench-state")).toHaveText("running");
});
