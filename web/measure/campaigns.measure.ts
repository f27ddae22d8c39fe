import type { Locator, Page } from "@playwright/test";
import { expect, test } from "../e2e/lab";
import type { LabServer } from "../e2e/lab-server";

const TIMES = Number(process.env.TIMES ?? 5);
const RUNS = Number(process.env.RUNS ?? 100_000);
const FIRST_ROW = "tbody tr";
const PLOT = "section[aria-label='Distribution of runs'] canvas";

const median = (values: number[]) => values.toSorted((a, b) => a - b)[Math.floor(values.length / 2)];

const say = (what: string, took: number[]) =>
  console.log(`${what}: median ${median(took).toFixed(0)} ms of ${took.map((ms) => ms.toFixed(0)).join(", ")}`);

/** Click, and return how long it takes until the result of that name shows something, ms. */
function clickUntil(button: Locator, name: string, shows: string): Promise<number> {
  return button.evaluate(
    (element, [heading, selector]) =>
      new Promise<number>((resolve) => {
        const began = performance.now();
        const look = () => {
          const result = document.querySelector("section[aria-label='Result']");
          if (result?.querySelector("h2")?.textContent === heading && result.querySelector(selector))
            requestAnimationFrame(() => resolve(performance.now() - began));
          else requestAnimationFrame(look);
        };
        (element as HTMLElement).click();
        look();
      }),
    [name, shows],
  );
}

async function openRuns(page: Page, server: LabServer): Promise<void> {
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?page=runs`);
  await page.getByRole("textbox", { name: "Name" }).waitFor();
}

/** Choose a campaign in the form: so many seeds, or so many points of a hypercube. */
async function fill(page: Page, kind: "seeds" | "points", count: number): Promise<void> {
  await page.getByText("Campaign", { exact: true }).click();
  if (kind === "seeds") {
    await page.getByText("Seeds alone").click();
    await page.getByRole("textbox", { name: "Seeds", exact: true }).fill(String(count));
    return;
  }
  await page.getByText("Latin hypercube").click();
  await page.getByRole("combobox", { name: "Spread evenly over 1: path" }).fill("sensor.noise_um");
  await page.getByRole("textbox", { name: "sensor.noise_um: from" }).fill("0.01");
  await page.getByRole("textbox", { name: "sensor.noise_um: to" }).fill("0.2");
  await page.getByRole("textbox", { name: "Points", exact: true }).fill(String(count));
}

let campaigns = 0;

/** Start the campaign in the form under a name of its own; return the time from the click to the first row, ms. */
async function start(page: Page, server: LabServer, count: number): Promise<number> {
  campaigns += 1;
  const name = `campaign ${campaigns}`;
  await page.getByRole("textbox", { name: "Name" }).first().fill(name);
  const seed = page.getByRole("textbox", { name: "Seed of the points" });
  const first = (await seed.count()) ? seed : page.getByRole("textbox", { name: "First seed" });
  await first.fill(String(campaigns * count));
  const took = await clickUntil(page.getByRole("button", { name: /^Start \d/ }), name, FIRST_ROW);
  const active = async () => {
    const { sweeps } = await server.ask<{ sweeps: { id: string; state: string }[] }>("GET", "/sweeps");
    return sweeps.filter(({ state }) => state === "queued" || state === "running");
  };
  for (const { id } of await active()) await server.ask("DELETE", `/sweeps/${id}`);
  await expect.poll(async () => (await active()).length).toBe(0);
  return took;
}

for (const [kind, count] of [
  ["seeds", 1000],
  ["points", 10_000],
] as const)
  test(`the first row of ${count} ${kind}`, async ({ page, server }) => {
    const [cold, warm]: number[][] = [[], []];
    for (let i = 0; i < TIMES; i++) {
      await server.stop();
      await server.start();
      await openRuns(page, server);
      await fill(page, kind, count);
      cold.push(await start(page, server, count));
      warm.push(await start(page, server, count));
    }
    say(`first row of ${count} ${kind}, right after the start of the server`, cold);
    say(`first row of ${count} ${kind}, processes there`, warm);
  });

test(`opening ${RUNS} runs`, async ({ page, server }) => {
  const sweep = { schema: 1, id: "large", scenario: "ch5-seven-step", set: { samples: 50 }, seeds: { count: RUNS } };
  const { id } = await server.ask<{ id: string }>("POST", "/sweeps", { sweep, label: "large" });
  const state = () => server.ask<{ state: string }>("GET", `/sweeps/${id}`).then((found) => found.state);
  await expect.poll(state, { timeout: 600_000, intervals: [1000] }).toBe("done");
  const [cold, warm]: number[][] = [[], []];
  for (let i = 0; i < TIMES; i++) {
    await server.stop();
    await server.start();
    for (const found of [cold, warm]) {
      await openRuns(page, server);
      const button = page.getByRole("button", { name: /^large/ });
      await button.waitFor();
      found.push(await clickUntil(button, "large", PLOT));
    }
  }
  say(`opening ${RUNS} runs, the first time after the start of the server`, cold);
  say(`opening ${RUNS} runs, again`, warm);
});
