import { readFileSync } from "node:fs";
import { benchOf } from "./classroom";
import { chooseTool, expect, front, pictureOf, SCOPE_CANVAS, test } from "./lab";

interface Capture {
  trigger_tick: number;
  end_tick: number;
}

test("a scope moves with device time, looks back while it runs on, and measures its signals; the picture is saved", async ({
  page,
  server,
  openBench,
}) => {
  await openBench("lab", { samples: 1_000_000 });
  await front(page, "Voltage");
  const scope = page.getByRole("region", { name: /^Scope: reference.voltage/ });
  const past = scope.getByRole("button", { name: "PAST → LIVE" });
  const clock = page.getByRole("timer", { name: "Device time" });
  const passes = async (seconds: number) => {
    const before = await clock.innerText();
    await server.advance(seconds);
    await expect(clock).not.toHaveText(before);
  };
  await passes(3);
  await scope.getByLabel(/^Plot/).focus();
  await page.keyboard.press("ArrowLeft");
  await expect(past).toBeVisible();
  await passes(1);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await past.click();
  await expect(scope.getByText("LIVE", { exact: true })).toBeVisible();

  await chooseTool(scope, /^Measure/);
  const figures = scope.getByRole("region", { name: "Measurements" });
  const row = figures.getByRole("row", { name: /drive voltage/ });
  await passes(1);
  // the first look plays 10 V at 2 kHz, and in open loop the drive is the reference
  await expect(row.getByRole("cell").nth(3)).toHaveText(/^7\.0[67]\d*\sV$/);
  await expect(row.getByRole("cell").nth(5)).toHaveText(/^(2\.000|1\.999|2\.001)\skHz$/);
  await expect(row.getByRole("cell").nth(8)).toHaveText(/^−?0\.\d°$/);
  await expect(row.getByRole("cell").nth(9)).toHaveText("1.000");
  await expect(figures.getByText("2.000 ms")).toBeVisible();
  const b = scope.getByRole("slider", { name: "Cursor B" });
  await b.focus();
  for (let i = 0; i < 25; i += 1) await b.press("ArrowLeft");
  await expect(figures.getByText("1.000 ms")).toBeVisible(); // 25 of 100 of a window of 4 ms
  await expect(figures.getByText("1.000 kHz")).toBeVisible();
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  await expect(scope.getByText("PAUSED", { exact: true })).toBeVisible();

  const save = async (kind: string) => {
    await scope.getByRole("button", { name: "Tools", exact: true }).click();
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("menuitem", { name: kind, exact: true }).click(),
    ]);
    return readFileSync(await download.path());
  };
  const svg = (await save("SVG")).toString();
  expect(svg).toContain("voltage, V");
  expect(svg).toContain("time of the device, ms");
  const png = await save("PNG");
  expect(png.subarray(1, 4).toString()).toBe("PNG");
  // twice the pixels of the drawing, from the header
  expect(png.readUInt32BE(16)).toBe(2 * Number(/width="(\d+)"/.exec(svg)?.[1]));
  const csv = (await save("CSV")).toString().split("\n");
  expect(csv[0]).toBe('"tick","time_ms","reference.voltage","drive.voltage"');
  expect(csv.length).toBeGreaterThan(100);
});

test("the captures of a trigger outlive the history: previous, next, newest, by keys, and live again", async ({
  page,
  server,
  openBench,
}) => {
  await openBench("lab", { samples: 10_000_000 });
  const bench = benchOf(page);
  const stepTo = async (tick: number) => {
    let { tick: now } = await server.ask<{ tick: number }>("GET", `/benches/${bench}`);
    for (let ticks = 0; now < tick; now += ticks) {
      ticks = Math.min(10_000, tick - now);
      await server.ask("POST", `/benches/${bench}/commands`, { kind: "step", ticks });
    }
  };
  const scope = page.getByRole("region", { name: /^Scope: plant\.displacement/ });
  const strip = scope.getByRole("group", { name: "Captures", exact: true });
  const words = strip.getByRole("status");
  const older = scope.getByRole("button", { name: "Previous capture" });
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await expect(strip).toBeHidden();
  await chooseTool(scope, /^Trigger/);
  await expect(words).toHaveText("no captures yet");
  await stepTo(30_000);
  await expect(words).toHaveText(/^50\scaptures kept$/);

  const { dt_ms: dt } = await server.ask<{ dt_ms: number }>("GET", `/benches/${bench}`);
  const list = async () =>
    (await server.ask<{ triggers: { captures: Capture[] }[] }>("GET", `/benches/${bench}/captures`)).triggers[0]
      .captures;
  const captures = await list();
  const at = (index: number) =>
    `capture ${index + 1} of 50 at ${(captures[index].trigger_tick * dt).toFixed(3)}\u00a0ms`;
  const picture = () => pictureOf(page, SCOPE_CANVAS);
  // the page may not have the newest yet
  await expect(async () => {
    await scope.getByRole("group", { name: /^Plot\./ }).press("l");
    await older.click();
    await expect(words).toHaveText(at(49), { timeout: 500 });
  }).toPass();
  await expect(scope.getByRole("button", { name: "PAST → LIVE" })).toBeVisible();
  await expect(scope.getByRole("button", { name: "Next capture" })).toBeDisabled();
  await older.click();
  await expect(words).toHaveText(at(48));
  await scope.getByRole("group", { name: /^Plot\./ }).focus();
  await page.keyboard.press("PageUp");
  await expect(words).toHaveText(at(47));
  await page.keyboard.press("PageDown");
  await expect(words).toHaveText(at(48));
  await page.keyboard.press("End");
  await expect(words).toHaveText(at(49));
  await page.keyboard.press("l");
  await expect(words).toHaveText(/^50\scaptures kept$/);

  // a page that comes back finds the same, and every sample of them although the history has gone on
  await page.reload();
  await expect(words).toHaveText(/^50\scaptures kept$/);
  const stand = async (index: number) => {
    const before = await picture();
    await scope.getByRole("slider", { name: "Capture" }).fill(String(index));
    await expect(words).toHaveText(at(index));
    await expect.poll(picture).not.toBe(before);
  };
  await stand(10);
  const kept = await picture();
  await stepTo(450_000);
  const { first_tick: first } = await server.ask<{ first_tick: number }>("GET", `/benches/${bench}`);
  expect(first).toBeGreaterThan(captures[49].end_tick);
  expect(await list(), "while it stands on one, the scope takes no others").toEqual(captures);
  await stand(11);
  await stand(10);
  await expect.poll(picture).toBe(kept);

  await scope.getByRole("button", { name: /↗/ }).click();
  await page.getByRole("textbox", { name: "Level" }).fill("1000");
  await expect(words).toHaveText("no captures yet");
  await expect(older).toBeDisabled();
  await page.getByRole("combobox", { name: "When it" }).selectOption("leaves");
  await page.getByRole("textbox", { name: "From" }).fill("-5");
  await page.getByRole("textbox", { name: "To" }).fill("5");
  await expect(scope.getByRole("button", { name: /● ⇤ −5\sV to 5\sV/ })).toBeVisible();
});
