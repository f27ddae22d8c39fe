import type { Page } from "@playwright/test";
import { expect, test } from "./classroom";
import { front, HYPOTHESES, inWords } from "./lab";

interface Answers {
  answers: { name: string; truth: string }[];
}

/** The texts in which a fault or a verdict could be read: words, names and titles of elements. */
const readable = (page: Page) =>
  page.locator("body").evaluate((body) => {
    const panels = Array.from(body.querySelectorAll(".dv-content-container, header, [role=status], [role=alert]"));
    // the question itself names the answers; games say the same of every bench
    const own = "section[aria-label='Hidden fault'], section[aria-label='Games']";
    return panels
      .filter((panel) => panel.querySelector(own) === null)
      .flatMap((panel) => [panel, ...Array.from(panel.querySelectorAll("*"))])
      .flatMap((part) => [
        ...Array.from(part.childNodes).flatMap((node) => (node.nodeType === 3 ? [node.textContent ?? ""] : [])),
        ...["aria-label", "title", "value"].map((name) => part.getAttribute(name) ?? ""),
      ])
      .filter((text) => text.trim() !== "");
  });

/** Panels without a choice of views, and those with one; each other tab is a scope with a title of its own. */
const ONE_VIEW = ["Faults", "Frequency response", "3D", "Why", "Published"];
const VIEWS = ["Device", "Loop", "Controller", "Diagnosis", "Compare", "Log", "Lesson"];

/** Bring each view of a panel to the front, one after the other. */
async function eachView(page: Page, title: string, look: (view: string) => Promise<void>): Promise<void> {
  const tab = page.getByRole("tab", { name: title, exact: true });
  await tab.click();
  if (ONE_VIEW.includes(title)) return look("");
  const bar = page.locator(".dv-tabs-and-actions-container").filter({ has: tab });
  const panel = VIEWS.includes(title) ? title : "Scope";
  const menu = bar.getByRole("button", { name: new RegExp(`^Views of ${panel}: `) });
  const views = page.getByRole("menuitem");
  await menu.click();
  await expect(views.first()).toBeVisible();
  const names = await views.allTextContents();
  for (const [at, name] of names.entries()) {
    if (at > 0) await menu.click();
    await views.filter({ hasText: name }).click();
    await look(name);
  }
}

const TELLING = [
  ...HYPOTHESES.flatMap(({ name }) => [name, inWords(name)]),
  ...["added_mass", "acts", "found ", "the truth is", "false switches"],
];

const HIDDEN = "A fault is hidden here, or none";

const panelOf = (page: Page) => page.getByRole("region", { name: "Hidden fault" });

/** Commit an answer at the highest confidence. */
async function answer(page: Page, hypothesis: string): Promise<void> {
  await page.getByRole("button", { name: "Answer", exact: true }).click();
  await panelOf(page)
    .getByRole("radio", { name: inWords(hypothesis), exact: true })
    .check();
  await panelOf(page).getByRole("slider").focus();
  await page.keyboard.press("End");
  await panelOf(page).getByRole("button", { name: "Commit the answer" }).click();
}

test("a class looks for hidden faults: no panel tells, a wrong and sure answer loses points, the teacher reveals", async ({
  page,
  server,
  group,
  student,
}) => {
  page.on("dialog", (dialog) => dialog.accept());
  const [ada, ben] = await Promise.all([student("Ada"), student("Ben")]);
  await page.goto(server.url);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await page.keyboard.press("m");
  const tile = (name: string) => page.getByRole("listitem", { name, exact: true });
  const all = page.getByRole("region", { name: "For all benches" });
  await expect(tile("Ben")).toBeVisible();
  await all.getByRole("button", { name: "Set hidden faults" }).click();
  await expect(all.getByText("Set hidden faults: 2 done.")).toBeVisible();
  for (const one of [ada, ben]) await expect(one.getByText(HIDDEN)).toBeVisible();
  await expect(tile("Ada").getByText(/^hidden: /)).toBeVisible();
  const { answers } = await server.ask<Answers>("GET", `/classes/${group.id}/blind`);
  const truth = Object.fromEntries(answers.map(({ name, truth }) => [name, truth]));

  for (let second = 0; second < 5; second += 1) await server.advance(1); // whatever is hidden has come by then
  await ada.keyboard.press("3");
  await front(ada, "Lesson", "Hidden fault");
  await expect(panelOf(ada).getByText("If there is a fault, it has come.")).toBeVisible();
  const tabs = await ada.getByRole("tab").allTextContents();
  expect(tabs.length).toBeGreaterThan(12);
  let seen = 0;
  for (const tab of tabs)
    await eachView(ada, tab, async (view) => {
      await expect.poll(async () => (await readable(ada)).length, { message: tab }).toBeGreaterThan(20);
      const telling = (await readable(ada)).filter((text) => TELLING.some((word) => text.includes(word)));
      expect(telling, `the texts of ${tab} ${view}`).toEqual([]);
      seen += 1;
    });
  expect(seen).toBeGreaterThan(25);
  await front(ada, "Lesson", "Hidden fault");
  await expect(ada.getByRole("region", { name: "Diagnosis by kalman" })).toHaveCount(0);
  await expect(ada.locator("iframe")).toHaveCount(0);

  await ada.reload(); // the server keeps the question
  await answer(ada, truth.Ada);
  await expect(panelOf(ada).getByText(/^Right: it is .* 100\spoints$/)).toBeVisible();
  await expect(panelOf(ada).getByText(/kalman said /)).toBeVisible();
  await front(ada, "Diagnosis", "Lanes");
  await expect(ada.getByRole("region", { name: "Diagnosis by kalman" })).toBeVisible();
  await answer(ben, truth.Ben === "healthy" ? "m+5" : "healthy");
  await expect(panelOf(ben).getByText(/^Wrong: it is .* −140\spoints$/)).toBeVisible();
  await expect(tile("Ada").getByText(/100.% sure$/)).toBeVisible();
  await expect(tile("Ben").getByText(/^−140\spoints$/)).toBeVisible();

  await page.getByRole("checkbox", { name: "Choose Ben" }).check();
  await all.getByRole("button", { name: "Set hidden faults" }).click();
  await expect(all.getByText("Set hidden faults: 1 done.")).toBeVisible();
  await expect(ben.getByText(HIDDEN)).toBeVisible();
  await all.getByRole("button", { name: "Reveal answers" }).click();
  await expect(all.getByText("Reveal answers: 1 done.")).toBeVisible();
  await expect(ben.getByText(HIDDEN)).toHaveCount(0);
  await expect(tile("Ben").getByText(/^no answer/)).toBeVisible();
});
