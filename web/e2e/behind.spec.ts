import type { Page } from "@playwright/test";
import { expect, SCOPE_CANVAS, test } from "./lab";
import { expectClean, SCREENS, showOn } from "./screens";
import { seriousViolations } from "./serious-violations";

interface Bench {
  id: string;
  tick: number;
  name: string;
  state: string;
  faults: { name: string }[];
  origin: { bench: string; tick: number; is_past: boolean } | null;
}

const shown = (page: Page) => new URL(page.url()).searchParams.get("bench") ?? "";

/** How many points of the first scope have a colour, given or take a little. */
const inked = (page: Page, [red, green, blue]: readonly number[]): Promise<number> =>
  page
    .locator(SCOPE_CANVAS)
    .first()
    .evaluate(
      (canvas: HTMLCanvasElement, wanted) => {
        const pen = canvas.getContext("2d") as CanvasRenderingContext2D;
        const { data } = pen.getImageData(0, 0, canvas.width, canvas.height);
        let found = 0;
        for (let at = 0; at < data.length; at += 4)
          if (wanted.every((part, i) => Math.abs(data[at + i] - part) < 10)) found += 1;
        return found;
      },
      [red, green, blue],
    );

/** The reference of the displacement is neutral: its faded colour on a light panel, from `palette.json`. */
const parts = (colour: string) => [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16));
const fadedOnWhite = (colour: string) => parts(colour).map((part) => Math.round(0.45 * part + 0.55 * 255));

test("a branch without a fault has the other future behind it, the difference shaded and drawn, named and closed", async ({
  page,
  server,
  openBench,
}) => {
  await page.emulateMedia({ colorScheme: "light" });
  await openBench("lab", { samples: 1_000_000 });
  const ask = (id: string) => server.ask<Bench>("GET", `/benches/${id}`);
  const bench = shown(page);
  await expect.poll(async () => (await ask(bench)).tick).toBeGreaterThan(300);
  await server.ask("POST", `/benches/${bench}/commands`, { fault: "stiffness", severity: 0.3 });
  const fault = (await ask(bench)).tick;
  await expect.poll(async () => (await ask(bench)).tick).toBeGreaterThan(fault + 200);

  await page.getByRole("tab", { name: "Events" }).click();
  await page.getByRole("button", { name: /^Branch without this: inject stiffness/ }).click();
  await expect.poll(() => shown(page)).not.toBe(bench);
  const branch = shown(page);
  await expect.poll(async () => (await ask(branch)).state).toBe("running");
  expect(await ask(branch)).toMatchObject({ faults: [], origin: { bench } });
  expect((await ask(branch)).name).toMatch(/^without inject stiffness/);
  const behind = page.getByText(/^Behind, faded: First look/);
  await expect(behind.first()).toBeVisible();
  await expect.poll(async () => (await ask(branch)).tick).toBeGreaterThan(fault + 100);
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  const colour = fadedOnWhite(await strokeOf(page));
  await expect.poll(() => inked(page, colour)).toBeGreaterThan(30);

  const timeline = page.getByRole("region", { name: "Timeline" });
  await timeline.getByRole("button", { name: "Compared with 1" }).click();
  const sheet = page.getByRole("dialog", { name: "Compare with other benches" });
  await sheet.getByRole("checkbox", { name: "Draw the difference on an axis of its own" }).check();
  await expect(page.getByText(/Dotted, on the axis Δ: the difference from First look/).first()).toBeVisible();
  const name = sheet.getByRole("textbox", { name: /^Name of First look/ });
  await name.fill("with the stiffer beams");
  await name.press("Enter");
  await expect.poll(async () => (await ask(bench)).name).toBe("with the stiffer beams");
  await expect(page.getByText(/^Behind, faded: with the stiffer beams\./).first()).toBeVisible();
  await sheet.getByRole("combobox", { name: "Aligned at" }).selectOption("the last fault of each");
  await expect(sheet.getByText("same time", { exact: true })).toBeVisible(); // the branch has no fault
  expect(await seriousViolations(page)).toEqual([]);

  await sheet.getByRole("button", { name: "Show" }).click();
  await expect.poll(() => shown(page)).toBe(bench);
  await expect(page.getByText(/^Behind, faded: without inject stiffness/).first()).toBeVisible();
  await timeline.getByRole("button", { name: "Compared with 1" }).click();
  await sheet.getByRole("button", { name: /^Close the bench without inject stiffness/ }).click();
  await expect(page.getByText(/^Behind, faded/)).toHaveCount(0);
  await expect(timeline.getByRole("button", { name: "Compare", exact: true })).toBeVisible();
  expect((await server.ask<{ benches: Bench[] }>("GET", "/benches")).benches.map(({ id }) => id)).not.toContain(branch);
});

/** The colour in which the first scope writes the swatch of its first trace. */
const strokeOf = (page: Page): Promise<string> =>
  page
    .getByRole("list", { name: "Signals" })
    .first()
    .locator("svg line, svg path")
    .first()
    .evaluate((line) => {
      const [red, green, blue] = getComputedStyle(line).stroke.match(/\d+/g) ?? ["0", "0", "0"];
      return `#${[red, green, blue].map((part) => Number(part).toString(16).padStart(2, "0")).join("")}`;
    });

test("benches, recordings and runs are put behind the traces, aligned at their faults, on every screen", async ({
  page,
  server,
  openBench,
}) => {
  await openBench("lab", { samples: 1_000_000 });
  const bench = shown(page);
  const command = (id: string, body: object) => server.ask("POST", `/benches/${id}/commands`, body);
  const ask = (id: string) => server.ask<Bench>("GET", `/benches/${id}`);
  const { id: other } = await server.ask<Bench>("POST", "/benches", { scenario: "first-look", paused: true });
  await command(other, { kind: "step", ticks: 700 });
  await command(other, { fault: "added_mass", severity: 0.1 });
  await command(other, { kind: "step", ticks: 1000 });
  await server.ask("PATCH", `/benches/${other}`, { name: "heavier" });
  const recording = await server.ask<{ id: string }>("POST", `/benches/${other}/recordings`, {
    name: "kept",
    past_ticks: 1500,
    ticks: 0,
  });
  const { id: run } = await server.ask<{ id: string }>("POST", "/runs", {
    scenario: "first-look",
    set: { samples: 2000 },
    label: "headless",
  });
  await expect.poll(async () => (await server.ask<{ state: string }>("GET", `/runs/${run}`)).state).toBe("done");
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  await command(bench, { fault: "added_mass", severity: 0.05 });
  const { tick } = await ask(bench);
  await command(bench, { kind: "step", ticks: 300 });

  await page.getByRole("region", { name: "Timeline" }).getByRole("button", { name: "Compare" }).click();
  const sheet = page.getByRole("dialog", { name: "Compare with other benches" });
  const add = sheet.getByRole("combobox", { name: "Add" });
  for (const [n, source] of [`b ${other}`, `r ${recording.id}`, `h ${run}`].entries()) {
    await expect(add.locator(`option[value="${source}"]`)).toHaveCount(1);
    await add.selectOption(source);
    await expect(sheet.getByRole("listitem")).toHaveCount(n + 1);
  }
  await sheet.getByRole("combobox", { name: "Aligned at" }).selectOption("the last fault of each");
  const shift = (700 - tick) * 0.01;
  const said = `${shift > 0 ? "+" : "−"}`;
  await expect(sheet.getByRole("listitem").first()).toContainText(shift === 0 ? "same time" : said);
  for (const screen of SCREENS.slice(0, 3)) {
    await showOn(page, screen);
    await expectClean(page, `compare at ${screen.width}`);
  }
});
