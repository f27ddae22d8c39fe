import { benchOf, classLine, expect, join, PHONE, test } from "./classroom";
import { chooseMore } from "./lab";

test("a class runs from its code to its end", async ({ page, server, elsewhere }) => {
  page.on("dialog", (dialog) => dialog.accept());
  await page.goto(server.url);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await page.keyboard.press("m");
  await page.getByLabel("Name of the class").fill("Tuesday");
  await page.getByRole("button", { name: "Open the class" }).click();
  const code = await page.getByLabel("Join code").innerText();
  const qr = page.getByRole("img", { name: /^QR code of .*\/join\?code=/ });
  await expect(qr).toBeVisible();
  await expect.poll(() => qr.evaluate((image: HTMLImageElement) => image.naturalWidth)).toBeGreaterThan(200);
  await page.getByRole("button", { name: "Show on the wall" }).click();
  await expect(page.getByRole("dialog", { name: "Tuesday" })).toContainText(code);
  await page.keyboard.press("Escape");
  await expect(page.getByRole("dialog")).toHaveCount(0);

  const [ada, emmy] = [await elsewhere(), await elsewhere(PHONE)];
  await Promise.all([join(ada, server, code, "Ada"), join(emmy, server, code, "Emmy")]);
  expect(benchOf(ada)).not.toBe(benchOf(emmy));
  const pages = ada.getByRole("navigation", { name: "Pages" });
  await expect(pages.getByRole("button", { name: "Gallery" })).toBeVisible();
  await expect(pages.getByRole("button", { name: "Class" })).toHaveCount(0);
  for (const name of [/^Fork/, /^Share/]) await expect(ada.getByRole("button", { name })).toHaveCount(0);

  // the tiles show the fault of one student and the hand of the other
  const tile = (name: string) => page.getByRole("listitem", { name, exact: true });
  await ada.getByRole("button", { name: /^Inject .* Added mass$/ }).click();
  await expect(tile("Ada").getByText(/^Added mass/)).toBeVisible();
  await expect(tile("Emmy").getByText("no fault")).toBeVisible();
  await emmy.getByRole("button", { name: "Raise hand" }).click();
  await expect(page.getByRole("region", { name: "Students" }).getByRole("listitem").first()).toContainText("Emmy");
  await page.getByRole("button", { name: "Lower the hand of Emmy" }).click();
  await expect(emmy.getByRole("button", { name: "Raise hand" })).toBeVisible();

  // commands for all benches, or for chosen ones
  const all = page.getByRole("region", { name: "For all benches" });
  await all.getByRole("button", { name: "Freeze" }).click();
  await expect(all.getByText("Freeze: 2 done.")).toBeVisible();
  for (const one of [ada, emmy]) await expect(one.getByTestId("bench-state")).toHaveText("paused");
  await page.getByRole("checkbox", { name: "Choose Emmy" }).check();
  await all.getByRole("button", { name: "Release" }).click();
  await expect(emmy.getByTestId("bench-state")).toHaveText("running");
  await expect(ada.getByTestId("bench-state")).toHaveText("paused");
  await all.getByRole("button", { name: "Choose none" }).click();

  const before = benchOf(ada);
  await all.getByLabel("Scenario", { exact: true }).selectOption("ch5-seven-step");
  await all.getByRole("button", { name: "Begin on all" }).click();
  await expect.poll(() => benchOf(ada)).not.toBe(before);
  await expect(ada.getByRole("region", { name: "Steps of the scenario" })).toBeVisible();
  await expect(emmy.getByRole("heading", { name: /^Seven-step/ })).toBeVisible();
  await all.getByRole("button", { name: "Start all together" }).click();
  await expect(all.getByText("Start all together: 2 done.")).toBeVisible();
  await tile("Ada").getByRole("button", { name: "Ada", exact: true }).click();
  await expect.poll(() => benchOf(page)).toBe(benchOf(ada));
  await page.goBack();

  const { classes } = await server.ask<{ classes: { id: string }[] }>("GET", "/classes");
  await server.ask("POST", `/classes/${classes[0].id}/commands`, { command: { make_safe: "to be tried" } });
  await expect(ada.getByTestId("bench-state")).toHaveText("tripped");
  await all.getByRole("button", { name: "Reset 2 trips" }).click();
  await expect(ada.getByTestId("bench-state")).toHaveText("paused");
  await expect(all.getByRole("button", { name: /^Reset/ })).toHaveCount(0);

  await page.getByRole("button", { name: "Activity" }).click();
  const log = page.getByRole("list", { name: "Activity, newest first" });
  await expect(log.getByText("began a scenario on all benches")).toBeVisible();
  await expect(log.getByRole("listitem").filter({ hasText: "Ada" }).first()).toContainText(/tick|joined/);
  await page.keyboard.press("Escape");

  await page.getByRole("button", { name: "What can be done with Emmy" }).click();
  await page.getByRole("menuitem", { name: "Send away…" }).click();
  await expect(emmy.getByText("Your session has ended")).toBeVisible();
  await expect(emmy.getByRole("link", { name: "Join a class" })).toHaveAttribute("href", "./join");
  await expect(tile("Emmy")).toHaveCount(0);
  await page.getByRole("button", { name: "End the class…" }).click();
  await expect(page.getByLabel("Name of the class")).toBeVisible();
  await expect(ada.getByText("Your session has ended")).toBeVisible();
});

test("a teacher shows one bench on all screens, arranges the panels and asks for a vote", async ({
  page,
  openBench,
  student,
}) => {
  const [ada, emmy] = await Promise.all([student("Ada"), student("Emmy", PHONE)]);
  const own = [benchOf(ada), benchOf(emmy)];
  await openBench("lab");
  await page.keyboard.press("m");
  await page.getByRole("button", { name: "Show my bench to all" }).click();
  await expect(page.getByText("All see one bench")).toBeVisible();
  await page.keyboard.press("m");
  await expect(classLine(page)).toContainText("All of Tuesday see this bench.");
  for (const one of [ada, emmy]) {
    await expect.poll(() => benchOf(one)).toBe(benchOf(page));
    await expect(classLine(one)).toContainText("Your teacher shows this bench to all.");
    for (const name of ["Pause", "Stop"]) await expect(one.getByRole("button", { name, exact: true })).toHaveCount(0);
  }
  await expect(page.getByTitle("Who is here")).toHaveText("2 look on");
  await ada.getByRole("button", { name: "My own bench" }).click();
  await expect.poll(() => benchOf(ada)).toBe(own[0]);
  await expect(ada.getByRole("button", { name: "Pause" })).toBeVisible();
  await ada.getByRole("button", { name: "See it" }).click();
  await expect.poll(() => benchOf(ada)).toBe(benchOf(page));
  await classLine(page).getByRole("button", { name: "End showing" }).click();
  await expect.poll(() => [benchOf(ada), benchOf(emmy)]).toEqual(own);

  const layout = () => new URL(ada.url()).searchParams.get("layout");
  const before = layout();
  await chooseMore(page, /^Save, rename or share/);
  await page.getByRole("button", { name: "Give it to all of Tuesday" }).click();
  await page.keyboard.press("Escape");
  await expect(classLine(ada)).toContainText("Your teacher has arranged your panels: lab.");
  await classLine(ada).getByRole("button", { name: "Back to mine" }).click();
  await expect(classLine(ada)).toHaveCount(0);
  await expect.poll(layout).toBe(before ?? "lecture");
  await expect(classLine(emmy)).toHaveCount(0); // a phone has one column

  await page.getByTitle(/change bench/).click();
  await page.getByRole("menuitem", { name: /^Fault diagnosis/ }).click();
  const strip = page.getByRole("region", { name: "Lecture", exact: true });
  await expect(strip).toContainText("1 of 10");
  await page.keyboard.press("PageDown");
  await expect(strip).toContainText("Ask by a vote");
  await page.keyboard.press("a");
  await expect(page.getByText("0 of 2 have voted")).toBeVisible();
  const card = emmy.getByRole("region", { name: "Vote" });
  await expect(card).toContainText("At 24 ms the device changes: it swings 8 % further.");
  await card.getByRole("button", { name: /^healthy/ }).click();
  await expect(card).toContainText("You can change it");
  await card.getByRole("button", { name: /^mass \+5/ }).click();
  await expect(card.getByRole("button", { name: /^mass \+5/ })).toHaveAttribute("aria-pressed", "true");
  await expect(page.getByText("1 of 2 have voted")).toBeVisible();
  await expect(page.getByRole("meter")).toHaveCount(0); // no one sees an answer before the vote is revealed
  await page.getByRole("button", { name: "Reveal" }).click();
  await expect(page.getByRole("list", { name: "Results" })).toContainText(/mass \+5.* right.*1\svote/);
  await expect(page.getByRole("img", { name: /1\svote for mass \+5/ })).toBeVisible();
  await expect(card).toContainText(/The right answer: mass \+5/);
});
