import { benchOf } from "./classroom";
import { expect, front, test } from "./lab";

interface Recording {
  id: string;
  start_tick: number;
  ticks: number;
}

test("a bench is recorded with its past, replayed in a loop, compared and deleted", async ({
  page,
  server,
  openBench,
}) => {
  await openBench("lab");
  const bench = benchOf(page);
  await server.advance(2);
  await front(page, "Compare", "Recordings");
  const panel = page.getByRole("region", { name: "Recordings" });
  await expect(panel.getByText("Nothing recorded yet")).toBeVisible();
  const record = async (name: string, begins: string) => {
    await panel.getByRole("textbox", { name: "Name" }).fill(name);
    await panel.getByRole("textbox", { name: "Length" }).fill("2");
    await panel.getByRole("combobox", { name: "Begins" }).selectOption(begins);
    await panel.getByRole("button", { name: begins ? "Arm" : "Record", exact: true }).click();
    await expect(panel.getByText(name, { exact: true })).toBeVisible();
    await server.advance(2);
    await expect(panel.getByRole("button", { name: `Replay ${name}` })).toBeVisible();
  };
  await record("first", "");
  await record("second", "plant.displacement");
  const { recordings } = await server.ask<{ recordings: Recording[] }>("GET", "/recordings");
  // 2 ms from the moment on and 1 ms before it, at 100 kHz
  expect(recordings.map(({ ticks }) => ticks)).toEqual([300, 300]);
  const [second] = recordings;

  await panel.getByRole("button", { name: "Compare second with another" }).click();
  await panel.getByText("first on first").click();
  const compare = panel.getByRole("button", { name: "Compare", exact: true }).first();
  await compare.click();
  await expect(panel.getByRole("status")).toHaveText(/^(Pass|Fail): \d+ of \d+ signals within 1\s% over 300\sticks/);
  await panel.getByRole("textbox", { name: "Tolerance" }).fill("0");
  await compare.click();
  await expect(panel.getByRole("status")).toHaveText(/^Fail/);
  await expect(panel.getByRole("row", { name: /plant.displacement .*fail/ })).toBeVisible();
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    panel.getByRole("link", { name: "NPZ" }).first().click(),
  ]);
  expect(download.suggestedFilename()).toBe("second.npz");

  await panel.getByRole("button", { name: "Replay second" }).click();
  const bar = page.getByRole("region", { name: "Replay" });
  await expect(bar).toContainText("second");
  await bar.getByRole("combobox", { name: "Speed of the replay" }).selectOption("0.5");
  await bar.getByRole("button", { name: "Loop" }).click();
  await expect(bar.getByRole("button", { name: "Loop" })).toHaveAttribute("aria-pressed", "true");
  const tick = async () => (await server.ask<{ tick: number }>("GET", `/benches/${benchOf(page)}`)).tick;
  // a loop of 3 ms at 1 ms a second comes back to where it was
  const seen: number[] = [];
  for (let look = 0; look < 4; look += 1) {
    await server.advance(1);
    seen.push(await tick());
  }
  expect(seen.some((at, i) => i > 0 && at < seen[i - 1])).toBe(true);
  expect(Math.min(...seen)).toBeGreaterThanOrEqual(second.start_tick);
  expect(Math.max(...seen)).toBeLessThanOrEqual(second.start_tick + 300);
  await bar.getByRole("button", { name: "Leave" }).click();
  await expect(bar).toHaveCount(0);
  await expect.poll(() => benchOf(page)).toBe(bench);

  await front(page, "Compare", "Recordings");
  page.on("dialog", (dialog) => dialog.accept());
  for (const name of ["second", "first"]) {
    await panel.getByRole("button", { name: `Delete ${name}` }).click();
    await expect(panel.getByRole("button", { name: `Delete ${name}` })).toHaveCount(0);
  }
  await expect(panel.getByText("Nothing recorded yet")).toBeVisible();
});

test("a replay has the sentences of the narrator as its captions, wherever it is; they are silenced by a key", async ({
  page,
  server,
}) => {
  const { id } = await server.ask<{ id: string }>("POST", "/benches", { scenario: "ch5-seven-step", paused: true });
  const made = await server.ask<{ id: string }>("POST", `/benches/${id}/recordings`, { name: "steps" });
  await server.ask("POST", `/benches/${id}/commands`, { kind: "step", ticks: 3200 });
  await server.ask("POST", `/benches/${id}/recordings/${made.id}/stop`);
  const replay = await server.ask<{ id: string }>("POST", `/recordings/${made.id}/replay`, { paused: true });
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?bench=${replay.id}&layout=lecture`);
  const caption = page.getByRole("region", { name: "What happens now" });
  await expect(caption).toContainText("Each lane of Diagnosis is one guess at the device");
  const go = (tick: number) => server.ask("POST", `/benches/${replay.id}/commands`, { kind: "seek", tick });
  await go(3100);
  await expect(caption).toContainText("the bank now favours mass +10\u00a0%");
  await go(2050);
  await expect(caption).toContainText("the bank now favours mass +5\u00a0%");
  await go(100);
  await expect(caption).toContainText("Each lane of Diagnosis");

  await page.keyboard.press("q");
  await expect(caption).toHaveCount(0);
  await page.reload();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await expect(caption).toHaveCount(0);
  await page.keyboard.press("q");
  await expect(caption).toBeVisible();

  await page.keyboard.press("3");
  await front(page, "Log", "Narrator");
  const ahead = page.getByRole("button", { name: /At 60.64/ });
  await expect(ahead).toHaveAttribute("data-ahead", "true");
  await ahead.click();
  await expect(caption).toContainText("a fault changes: added mass");
});
