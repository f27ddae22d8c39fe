import type { Browser, Page } from "@playwright/test";
import { expect, HYPOTHESES, inWords, test } from "./lab";
import { expectFits, SCREENS, showOn } from "./screens";
import { seriousViolations } from "./serious-violations";

test.describe.configure({ timeout: 480_000 });

interface Shown {
  faults: unknown[];
  pending: unknown[];
  scores: object;
  blind: { by_tick: number } | null;
  tick: number;
}

interface Answers {
  answers: { name: string; truth: string; points: number }[];
}

/** What people could read of a fault or of a verdict: text, and what is said of pictures and on pointing. */
const readable = (page: Page) =>
  page.locator("body").evaluate((body) => {
    const panels = Array.from(body.querySelectorAll(".dv-content-container, header, [role=status], [role=alert]"));
    // the question itself names the answers; games say the same of every bench
    const own = "section[aria-label='Blind diagnosis'], section[aria-label='Games']";
    return panels
      .filter((panel) => panel.querySelector(own) === null)
      .flatMap((panel) => [panel, ...Array.from(panel.querySelectorAll("*"))])
      .flatMap((part) => [
        ...Array.from(part.childNodes).flatMap((node) => (node.nodeType === 3 ? [node.textContent ?? ""] : [])),
        ...["aria-label", "title", "value"].map((name) => part.getAttribute(name) ?? ""),
      ])
      .filter((text) => text.trim() !== "");
  });

const TELLING = [
  ...HYPOTHESES.map(({ name }) => inWords(name)).filter((name) => name !== "healthy"),
  ...HYPOTHESES.map(({ name }) => name).filter((name) => name !== "healthy"),
  ...["healthy", "added_mass", "acts", "found ", "the truth is", "false switches"],
];

const HIDDEN = "A fault is hidden here, or none";

const panelOf = (page: Page) => page.getByRole("region", { name: "Blind diagnosis" });

test("no panel tells the fault until an answer is committed, and the server tells nobody", async ({
  page,
  openBench,
  server,
}) => {
  await openBench("research");
  const id = new URL(page.url()).searchParams.get("bench");
  const bench = () => server.ask<Shown>("GET", `/benches/${id}`);
  await page.getByRole("tab", { name: "Blind diagnosis" }).click();
  await expect(panelOf(page).getByText(/A right answer that is 100 % sure earns 100 points/)).toBeVisible();
  await panelOf(page).getByRole("button", { name: "Hide a fault" }).click();
  await expect(panelOf(page).getByRole("button", { name: "Commit the answer" })).toBeVisible();
  await expect(page.getByText("Hidden while you look for the fault").first()).toBeVisible();
  await expect(page.locator(".mantine-Notification-root")).toHaveCount(0);
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
  await expect
    .poll(async () => (await bench()).tick, { timeout: 120_000 })
    .toBeGreaterThan((await bench()).blind?.by_tick ?? 0);
  expect(await bench()).toMatchObject({ faults: [], pending: [], scores: {} });
  await expect(panelOf(page).getByText("If there is a fault, it has come.")).toBeVisible();

  await page.keyboard.press("Shift+S");
  const sheet = page.getByRole("dialog", { name: "Share this experiment" });
  await expect(sheet.getByText("Answer first")).toBeVisible();
  await expect(sheet.getByRole("textbox")).toHaveCount(0);
  await sheet.getByRole("button", { name: "Close" }).click();

  const tabs = await page.getByRole("tab").allTextContents();
  expect(tabs.length).toBeGreaterThan(15);
  for (const tab of tabs) {
    await page.getByRole("tab", { name: tab, exact: true }).click();
    const texts = await readable(page);
    expect(texts.length, tab).toBeGreaterThan(20);
    const telling = texts.filter((text) => TELLING.some((word) => text.includes(word)));
    expect(telling, `what ${tab} tells`).toEqual([]);
  }
  await expect(page.getByRole("region", { name: "Diagnosis by kalman" })).toHaveCount(0);
  await expect(page.locator("iframe")).toHaveCount(0);
  await page.getByRole("button", { name: "Choose signals" }).first().click();
  await page.getByRole("textbox", { name: "Search signals" }).fill("winner");
  await expect(page.getByText("No signal of this bench matches.")).toBeVisible();
  await page.keyboard.press("Escape");

  await page.reload(); // the server keeps it, whatever page is opened
  await page.getByRole("button", { name: "Answer", exact: true }).click();
  await panelOf(page)
    .getByRole("radio", { name: inWords("m+5"), exact: true })
    .check();
  await panelOf(page).getByRole("button", { name: "Commit the answer" }).click();
  await expect(panelOf(page).getByText(/^(Right|Wrong): it is /)).toBeVisible();
  await expect(panelOf(page).getByText(/kalman said /)).toBeVisible();
  await expect(panelOf(page).getByRole("row")).toHaveCount(2);
  await page.getByRole("tab", { name: "Diagnosis", exact: true }).click();
  await expect(page.getByRole("region", { name: "Diagnosis by kalman" })).toBeVisible();
  await page.getByRole("tab", { name: "Events" }).click();
  await expect(page.getByRole("button", { name: /kalman found/ }).first()).toBeVisible();
});

async function student(browser: Browser, origin: string, code: string, name: string): Promise<Page> {
  const page = await (await browser.newContext({ viewport: { width: 1440, height: 900 } })).newPage();
  await page.route("**/3d/", (route) => route.fulfill({ contentType: "text/html", body: "" }));
  await page.goto(`${origin}/join`);
  await page.getByLabel("Code on the wall").fill(code);
  await page.getByLabel("Your name").fill(name);
  await page.getByRole("button", { name: "Join" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  return page;
}

async function answer(page: Page, said: string): Promise<void> {
  await page.getByRole("button", { name: "Answer", exact: true }).click();
  const panel = panelOf(page);
  await panel.getByRole("radio", { name: inWords(said), exact: true }).check();
  await panel.getByRole("slider").focus();
  await page.keyboard.press("End");
  await panel.getByRole("button", { name: "Commit the answer" }).click();
}

test("a class: wrong and sure loses points, right and sure gains, the rest is revealed", async ({
  page,
  browser,
  server,
}) => {
  page.on("dialog", (dialog) => dialog.accept());
  const group = await server.ask<{ id: string; code: string }>("POST", "/classes", { name: "Blind" });
  await page.goto(server.url);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  const [ada, ben] = await Promise.all(["Ada", "Ben"].map((name) => student(browser, server.origin, group.code, name)));
  await page.keyboard.press("m");
  const tile = (name: string) => page.getByRole("listitem", { name, exact: true });
  await expect(tile("Ben")).toBeVisible();
  const all = page.getByRole("region", { name: "For all benches" });
  await all.getByRole("button", { name: "Blind faults" }).click();
  await expect(all.getByText("Blind faults: 2 done.")).toBeVisible();
  for (const one of [ada, ben]) await expect(one.getByText(HIDDEN)).toBeVisible({ timeout: 120_000 });
  const { answers } = await server.ask<Answers>("GET", `/classes/${group.id}/blind`);
  const truth = Object.fromEntries(answers.map(({ name, truth }) => [name, truth]));
  await expect(tile("Ada").getByText(/^hidden: /)).toBeVisible();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
  await answer(ada, truth.Ada);
  await expect(panelOf(ada).getByText(/^Right: it is .* 100\spoints$/)).toBeVisible();
  await answer(ben, truth.Ben === "healthy" ? "m+5" : "healthy");
  await expect(panelOf(ben).getByText(/^Wrong: it is .* −140\spoints$/)).toBeVisible();
  await expect(tile("Ada").getByText(/100.% sure$/)).toBeVisible();
  await expect(tile("Ben").getByText(/^−140\spoints$/)).toBeVisible();

  await ada.context().close();
  await page.getByRole("checkbox", { name: "Choose Ben" }).check();
  await all.getByRole("button", { name: "Blind faults" }).click();
  await expect(all.getByText("Blind faults: 1 done.")).toBeVisible();
  await expect(ben.getByText(HIDDEN)).toBeVisible({ timeout: 120_000 });
  await showOn(ben, SCREENS[3]);
  await expectFits(ben, "the page of a student with a hidden fault, on a phone");
  await all.getByRole("button", { name: "Reveal all" }).click();
  await expect(all.getByText("Reveal all: 1 done.")).toBeVisible();
  await expect(ben.getByText(HIDDEN)).toHaveCount(0);
  await expect(tile("Ben").getByText(/^no answer/)).toBeVisible();
  await server.ask("DELETE", `/classes/${group.id}`);
  await ben.context().close();
});
