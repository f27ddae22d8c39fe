import type { Page } from "@playwright/test";
import { expect, test } from "./lab";
import { seriousViolations } from "./serious-violations";

const benchOf = (page: Page) => new URL(page.url()).searchParams.get("bench") ?? "";
const steps = (page: Page) => page.getByRole("region", { name: "Steps of the scenario" });
const hints = (page: Page) => page.getByRole("region", { name: "Notice" }).getByRole("listitem");

interface Happened {
  kind: string;
  tick: number;
  text: string;
}

interface Status {
  tick: number;
  time_scale: number;
  fast_forward: string | null;
}

test("who comes first gets a lecture in words, and the seven steps at a press, up to what was found at each", async ({
  page,
  server,
}) => {
  await page.goto(server.url);
  await expect(page.locator("html")).toHaveAttribute("data-size", "large");
  await expect(page.getByText("A live comb resonator: a voltage shakes a plate on thin beams.")).toBeVisible();
  await expect(page.getByRole("img", { name: /Probability of healthy, mass \+5\s%, mass \+10\s%/ })).toBeVisible();
  await expect(page.getByTitle(/m\+5: mass \+5\s%/)).toBeAttached();
  const first = benchOf(page);

  await page.getByRole("button", { name: "Run the seven steps" }).click();
  await expect(steps(page)).toContainText(/[23] of 7: Added mass \+\d+\s%, in \d+\ss/);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  const id = benchOf(page);
  const status = () => server.ask<Status>("GET", `/benches/${id}`);
  const jumps = async () => {
    const { events } = await server.ask<{ events: Happened[] }>("GET", `/benches/${id}/events`);
    return events.filter((e) => e.kind === "fast_forward").map((e) => [e.tick, e.text]);
  };
  const before = (tick: number) => `as fast as possible to shortly before tick ${tick}`;
  expect(await jumps()).toEqual([[0, `quiet lead: ${before(2000)}`]]);
  const led = await status();
  expect(led).toMatchObject({ time_scale: 0.002, fast_forward: null });
  expect(led.tick).toBeGreaterThanOrEqual(1800);
  await expect(page.getByRole("combobox", { name: "Time window" }).last()).toHaveValue("50");

  // a step takes 50 s at that pace: none passes by unseen on a slow page
  await server.ask("POST", `/benches/${id}/commands`, { kind: "time_scale", value: 0.0004 });
  const onwards = steps(page).getByRole("button", { name: /^(Skip|To the end)$/ });
  const press = () => onwards.click({ timeout: 5000 }).catch(() => undefined);
  for (const words of ["Added mass +10", "Beam stiffness +5", "Beam stiffness +10", "Damping +30", "healed"])
    await expect(async () => {
      await press();
      await expect(steps(page).locator("p")).toContainText(words, { timeout: 8000 });
    }).toPass();
  await expect(async () => {
    await press();
    expect((await status()).tick).toBe(9000);
  }).toPass();
  const found = page.getByRole("list", { name: "What was found at each step" });
  await expect(found.getByRole("listitem")).toHaveCount(7);
  await expect(found.getByRole("listitem").nth(1)).toContainText(/2 Added mass \+5\s%.*found mass \+5\s% after \d/);
  await expect(found.getByRole("listitem").nth(6)).toContainText(/7 healed.*found healthy after/);
  expect(await seriousViolations(page)).toEqual([]);
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await steps(page).getByRole("button", { name: "Replay step" }).click();
  await expect.poll(async () => (await jumps()).at(-1)).toEqual([0, before(7000)]);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await steps(page).getByRole("button", { name: "What was found" }).click();
  await found.getByRole("button", { name: /^2 Added mass/ }).click();
  await expect.poll(async () => (await jumps()).at(-1)).toEqual([0, before(2000)]);
  for (const bench of [first, id]) await server.ask("DELETE", `/benches/${bench}`);
});

test("the page says that a quiet lead runs, and who sets a pace ends it", async ({ page, server, openDocument }) => {
  await page.request.get(server.url);
  const far = { at_sample: 2_000_000_000, fault: "added_mass", severity: 0.05 };
  const { id } = await server.ask<{ id: string }>("POST", "/benches", {
    scenario: "first-look",
    set: { events: [far] },
    quiet_lead: true,
  });
  await page.goto(`${server.origin}/?bench=${id}&layout=lab`);
  await expect(page.getByText("quiet lead, fast")).toBeVisible();
  await expect(steps(page)).toContainText(/2 of 2: Added mass \+5\s%, in \d/);
  await page.keyboard.press("]");
  await expect(page.getByText("quiet lead, fast")).toBeHidden();
  await expect(page.getByRole("group", { name: "Time scale" })).toContainText("4.00 ms/s");
  await server.ask("DELETE", `/benches/${id}`);

  await openDocument({ ...(await server.ask<{ document: object }>("GET", "/scenarios/gyro-first-look")).document });
  await expect(hints(page).first()).toContainText("change the angular rate");
});

test("hints are ticked off when they are done, and never come back once dismissed", async ({ page, openBench }) => {
  await openBench("lecture");
  const ticked = page.getByRole("region", { name: "Notice" }).locator("li[data-done=true]");
  await expect(hints(page)).toHaveCount(3);
  await expect(ticked).toHaveCount(0);
  await page
    .getByRole("button", { name: "Inject Added mass +5 %" })
    .or(page.getByRole("button", { name: /^Inject \+5/ }))
    .first()
    .click();
  await expect(ticked).toHaveText([/^inject Added mass/, /^watch Diagnosis/]);
  const close = page.getByRole("button", { name: "Dismiss the hints" });
  await page.setViewportSize({ width: 820, height: 1180 });
  const intro = await page.getByText("A live comb resonator").boundingBox();
  const box = await close.boundingBox();
  expect(box && intro && box.y < intro.y + intro.height).toBe(true);
  await close.click();
  await expect(hints(page)).toHaveCount(0);
  await page.reload();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await expect(hints(page)).toHaveCount(0);
});

test("a presentation shows panels, title, state and clock alone, by key, menu and link", async ({
  page,
  openBench,
}) => {
  await openBench("lecture");
  const around = [
    page.getByRole("navigation", { name: "Pages" }),
    page.getByRole("region", { name: "Notice" }),
    page.getByRole("button", { name: "Add or close panels" }).first(),
    page.getByRole("combobox", { name: "Controller" }),
  ];
  for (const part of around) await expect(part).toBeVisible();
  await page.keyboard.press("p");
  for (const part of around) await expect(part).toBeHidden();
  await expect(page.getByRole("heading", { name: /^First look/ })).toBeVisible();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await expect(page.getByRole("timer")).toBeVisible();
  await expect(page).toHaveURL(/present=1/);
  await page.keyboard.press("p");
  for (const part of around) await expect(part).toBeVisible();
  await expect(page).not.toHaveURL(/present/);

  await page.getByRole("button", { name: "More" }).click();
  await page.getByRole("menuitem", { name: /^Present/ }).click();
  await expect(around[0]).toBeHidden();
  await page.reload();
  await expect(page.getByRole("heading", { name: /^First look/ })).toBeVisible();
  await expect(around[0]).toBeHidden();
  await page.keyboard.press("Escape");
  await expect(around[0]).toBeVisible();
});

test("the letters of a lecture grow with the window, on canvases too, and a chosen layout stays", async ({
  page,
  openBench,
}) => {
  const sizes: number[][] = [];
  await openBench("lecture");
  for (const [width, height] of [
    [1366, 768],
    [1920, 1080],
    [3840, 2160],
  ]) {
    await page.setViewportSize({ width, height });
    const letters = () =>
      page.evaluate(() => {
        const tab = document.querySelector("[role=tab]");
        const lanes = document.querySelector("[title*='m+5']");
        return [Number.parseFloat(tab ? getComputedStyle(tab).fontSize : "0"), lanes?.clientWidth ?? 0];
      });
    const last = sizes.at(-1) ?? [0, 0];
    await expect.poll(async () => (await letters()).every((size, i) => size > last[i] * 1.2)).toBe(true);
    sizes.push(await letters());
  }
  expect(sizes[2][0] / sizes[0][0]).toBeGreaterThan(2.5);

  await page.setViewportSize({ width: 1440, height: 900 });
  await page.keyboard.press("2");
  await expect(page.locator("html")).toHaveAttribute("data-size", "normal");
  const { origin } = new URL(page.url());
  await page.goto(`${origin}/?bench=${benchOf(page)}`);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await expect(page.locator("html")).toHaveAttribute("data-size", "normal");
});
