import { benchOf, openClass, student } from "./classroom";
import { expect, test } from "./lab";
import { expectClean, SCREENS } from "./screens";
import { seriousViolations } from "./serious-violations";

test.describe.configure({ timeout: 480_000 });

test("one bench on all screens, a layout for all, all started together, a hand lowered", async ({
  page,
  openBench,
  browser,
  server,
}) => {
  page.on("dialog", (dialog) => dialog.accept());
  const group = await openClass(server);
  const [ada, emmy] = await Promise.all([
    student(browser, server, group, "Ada"),
    student(browser, server, group, "Emmy", SCREENS[3]),
  ]);
  const own = [benchOf(ada), benchOf(emmy)];
  await openBench("lab");
  await page
    .getByRole("button", { name: "More" })
    .or(page.getByRole("button", { name: /^Show this bench/ }))
    .click();
  const item = page.getByRole("menuitem", { name: "Show this bench to all of Tuesday" });
  if (await item.count()) await item.click();
  const said = page.getByRole("region", { name: "Class" });
  await expect(said).toContainText("All of Tuesday see this bench.");
  for (const one of [ada, emmy]) {
    await expect.poll(() => benchOf(one)).toBe(benchOf(page));
    await expect(one.getByRole("region", { name: "Class" })).toContainText("Your teacher shows this bench to all.");
    await expect(one.getByTestId("bench-state")).toHaveText("running");
    for (const name of ["Pause", "Stop"]) await expect(one.getByRole("button", { name, exact: true })).toHaveCount(0);
  }
  await expect(page.getByTitle("Who is here")).toHaveText("2 look on");
  await page.getByTitle("Who is here").click();
  await expect(page.getByRole("dialog")).toContainText("look on");
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
  await page.keyboard.press("Escape");
  await expectClean(ada, "a bench that is shown to all");
  await expectClean(emmy, "a bench that is shown to all, on a phone");
  await seriousViolations(emmy).then((found) => expect(found).toEqual([]));

  await ada.getByRole("button", { name: "My own bench" }).click();
  await expect.poll(() => benchOf(ada)).toBe(own[0]);
  await expect(ada.getByRole("button", { name: "Pause" })).toBeVisible();
  await ada.getByRole("button", { name: "See it" }).click();
  await expect.poll(() => benchOf(ada)).toBe(benchOf(page));
  await said.getByRole("button", { name: "End showing" }).click();
  await expect.poll(() => [benchOf(ada), benchOf(emmy)]).toEqual(own);

  const layout = () => new URL(ada.url()).searchParams.get("layout");
  const before = layout();
  await page
    .getByRole("button", { name: "More" })
    .or(page.getByRole("button", { name: "Layout", exact: true }))
    .click();
  await page.getByRole("menuitem", { name: /^Save, rename or share/ }).click();
  await page.getByRole("button", { name: "Give it to all of Tuesday" }).click();
  const given = ada.getByRole("region", { name: "Class" });
  await expect(given).toContainText("Your teacher has arranged your panels: lab.");
  await given.getByRole("button", { name: "Back to mine" }).click();
  await expect(given).toHaveCount(0);
  expect(layout()).toBe(before ?? "lecture");
  await expect(emmy.getByRole("region", { name: "Class" })).toHaveCount(0); // a phone has one column

  await page.keyboard.press("m");
  const all = page.getByRole("region", { name: "For all benches" });
  await all.getByRole("button", { name: "Start all together" }).click();
  await expect(all.getByText("Start all together: 2 done.")).toBeVisible();
  await emmy.getByRole("button", { name: "Raise hand" }).click();
  await page.getByRole("button", { name: "Lower the hand of Emmy" }).click();
  await expect(emmy.getByRole("button", { name: "Raise hand" })).toBeVisible();
  await page.getByRole("button", { name: "Show my bench to all" }).click();
  await expect(page.getByText("All see one bench")).toBeVisible();
  await Promise.all([ada, emmy].map((one) => one.context().close()));
  await server.ask("DELETE", `/classes/${group.id}`);
});
