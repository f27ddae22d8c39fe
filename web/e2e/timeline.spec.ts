import { benchOf } from "./classroom";
import { expect, front, test } from "./lab";

interface Bench {
  id: string;
  name: string;
  tick: number;
  state: string;
  controller: string;
  faults: { name: string }[];
  diagnosers: Record<string, { kind: string }>;
  origin: { bench: string; tick: number; is_past: boolean } | null;
}

test("the timeline goes back, branches begin there with one change each, and the other future is drawn behind them", async ({
  page,
  server,
  openBench,
}) => {
  await openBench("lab", { samples: 1_000_000 });
  const ask = (id = benchOf(page)) => server.ask<Bench>("GET", `/benches/${id}`);
  const bench = benchOf(page);
  const timeline = page.getByRole("region", { name: "Timeline" });
  const moment = timeline.getByRole("slider");
  const past = timeline.getByText(/^As it was at/);
  await server.advance(2);
  await server.ask("POST", `/benches/${bench}/commands`, { fault: "added_mass", severity: 0.1 });
  await server.advance(2);

  await moment.focus();
  await page.keyboard.press("Home");
  await expect(past).toBeVisible();
  await expect.poll(() => benchOf(page)).not.toBe(bench);
  await expect.poll(() => ask()).toMatchObject({ state: "paused", origin: { bench, is_past: true } });
  const looked = benchOf(page);
  const { tick } = await ask();
  await moment.focus();
  await page.keyboard.press("ArrowRight");
  await expect.poll(async () => (await ask()).tick).toBe(tick + 1);
  await timeline.getByRole("button", { name: "Back to now" }).click();
  await expect.poll(() => benchOf(page)).toBe(bench);
  const all = async () => (await server.ask<{ benches: Bench[] }>("GET", "/benches")).benches.map(({ id }) => id);
  await expect.poll(all).not.toContain(looked);

  const branch = async (choice: string, behind: RegExp) => {
    await timeline.getByRole("button", { name: "Branch here" }).click();
    await page.getByRole("menuitem", { name: choice }).click();
    await expect(page.getByText(behind).first()).toBeVisible();
    await expect.poll(() => benchOf(page)).not.toBe(bench);
    await expect.poll(async () => (await ask()).state).toBe("running");
    return ask();
  };
  await moment.focus();
  await page.keyboard.press("ArrowLeft");
  await expect(past).toBeVisible();
  expect(await branch("With PID", /^Behind, faded: First look/)).toMatchObject({
    controller: "pid",
    faults: [{ name: "added_mass" }],
    origin: { bench, is_past: false },
  });
  expect((await ask(bench)).controller).not.toBe("pid");
  const pid = benchOf(page);
  await timeline.getByRole("button", { name: "The other future" }).click();
  await expect.poll(() => benchOf(page)).toBe(bench);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  const compared = timeline.getByRole("button", { name: "Compared with 1" });
  const sheet = page.getByRole("region", { name: "Branches and runs" });
  await compared.click();
  await sheet.getByRole("button", { name: /^Close the bench with PID/ }).click();
  await expect(page.getByText(/^Behind, faded/)).toHaveCount(0);
  await expect.poll(all).not.toContain(pid);
  await page.keyboard.press("Escape");

  await front(page, "Log", "Events");
  await page.getByRole("button", { name: /^Branch without this: inject added_mass/ }).click();
  await expect.poll(() => benchOf(page)).not.toBe(bench);
  await expect.poll(() => ask()).toMatchObject({ state: "running", faults: [], origin: { bench } });
  expect((await ask(bench)).faults.map(({ name }) => name)).toEqual(["added_mass"]);
  await server.advance(2);
  await compared.click();
  await sheet.getByRole("checkbox", { name: "Draw the difference on an axis of its own" }).check();
  await expect(page.getByText(/Dotted, on the axis Δ: the difference from First look/).first()).toBeVisible();
  const name = sheet.getByRole("textbox", { name: /^Name of First look/ });
  await name.fill("heavier");
  await name.press("Enter");
  await expect.poll(async () => (await ask(bench)).name).toBe("heavier");
  await expect(page.getByText(/^Behind, faded: heavier\./).first()).toBeVisible();
  await sheet.getByRole("button", { name: "Show", exact: true }).click();
  await expect.poll(() => benchOf(page)).toBe(bench);
  await expect(page.getByText(/^Behind, faded: without inject added/).first()).toBeVisible();
  await page.keyboard.press("Escape");

  const other = await branch("With Consistency test", /^Behind, faded: heavier/);
  expect(Object.values(other.diagnosers).map(({ kind }) => kind)).toContain("consistency");
  expect(other.faults.map(({ name }) => name)).toEqual(["added_mass"]);
});
