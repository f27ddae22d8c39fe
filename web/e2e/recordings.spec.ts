import { expect, test } from "./lab";
import { expectFits } from "./screens";
import { seriousViolations } from "./serious-violations";

interface Recording {
  id: string;
  state: string;
  start_tick: number;
  ticks: number;
}

test("a bench is recorded with its past, replayed with a loop, compared and deleted", async ({
  page,
  server,
  openBench,
}) => {
  const kept = () => server.ask<{ recordings: Recording[] }>("GET", "/recordings");
  for (const { id } of (await kept()).recordings) await server.ask("DELETE", `/recordings/${id}`); // of tests before
  await openBench("lab");
  const live = page.url();
  await page.getByRole("tab", { name: "Recordings" }).click();
  const panel = page.getByRole("region", { name: "Recordings" });
  await expect(panel.getByText("Nothing recorded yet")).toBeVisible();
  await page.waitForTimeout(1500);

  const record = async (name: string, begins: string) => {
    await panel.getByRole("textbox", { name: "Name" }).fill(name);
    await panel.getByRole("textbox", { name: "Length" }).fill("2");
    await panel.getByRole("combobox", { name: "Begins" }).selectOption(begins);
    await panel.getByRole("button", { name: begins ? "Arm" : "Record", exact: true }).click();
    await expect(panel.getByRole("button", { name: `Replay ${name}` })).toBeVisible();
  };
  await record("first", "");
  await record("second", "plant.displacement");
  const { recordings } = await kept();
  // 2 ms from the moment on and 1 ms before it, at 100 kHz
  for (const one of recordings) expect(one.ticks).toBe(300);
  const [second] = recordings;

  await panel.getByRole("button", { name: "Compare second with another" }).click();
  await panel.getByText("first on first").click();
  await panel.getByRole("button", { name: "Compare", exact: true }).first().click();
  await expect(panel.getByRole("status")).toHaveText(/^(Pass|Fail): \d+ of \d+ signals within 1\s% over 300\sticks/);
  await panel.getByRole("textbox", { name: "Tolerance" }).fill("0");
  await panel.getByRole("button", { name: "Compare", exact: true }).first().click();
  await expect(panel.getByRole("status")).toHaveText(/^Fail/);
  await expect(panel.getByRole("row", { name: /plant.displacement .*fail/ })).toBeVisible();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
  await expectFits(page, "recordings", undefined, "recordings");

  const [download] = await Promise.all([
    page.waitForEvent("download"),
    panel.getByRole("link", { name: "NPZ" }).first().click(),
  ]);
  expect(download.suggestedFilename()).toBe("second.npz");

  await panel.getByRole("button", { name: "Replay second" }).click();
  const bar = page.getByRole("region", { name: "Replay" });
  await expect(bar).toContainText("second");
  await bar.getByRole("combobox", { name: "Speed of the replay" }).selectOption("0.01");
  await expect(page.getByText("20.0 µs/s").first()).toBeVisible();
  await bar.getByRole("combobox", { name: "Speed of the replay" }).selectOption("0.5");
  await bar.getByRole("button", { name: "Loop" }).click();
  const id = new URL(page.url()).searchParams.get("bench");
  const tick = async () => (await server.ask<{ tick: number }>("GET", `/benches/${id}`)).tick;
  // a loop of 3 ms at 1 ms a second: after a while it has been at its end and is at its beginning again
  const seen: number[] = [];
  const goesBack = async () => {
    seen.push(await tick());
    return seen.some((at, i) => i > 0 && at < seen[i - 1]);
  };
  await expect.poll(goesBack, { intervals: [200] }).toBe(true);
  expect(Math.min(...seen)).toBeGreaterThanOrEqual(second.start_tick);
  expect(Math.max(...seen)).toBeLessThanOrEqual(second.start_tick + 300);
  await page.getByRole("button", { name: "Pause" }).click();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));

  await bar.getByRole("button", { name: "Leave" }).click();
  await expect(bar).toHaveCount(0);
  expect(new URL(page.url()).searchParams.get("bench")).toBe(new URL(live).searchParams.get("bench"));
  await page.getByRole("tab", { name: "Recordings" }).click();
  page.on("dialog", (dialog) => dialog.accept());
  await panel.getByRole("button", { name: "Delete second" }).click();
  await expect(panel.getByRole("button", { name: "Delete second" })).toHaveCount(0);
  await panel.getByRole("button", { name: "Delete first" }).click();
  await expect(panel.getByText("Nothing recorded yet")).toBeVisible();
});
