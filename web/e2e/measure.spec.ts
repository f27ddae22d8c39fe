import { readFileSync } from "node:fs";
import { expect, SCOPE_CANVAS, test } from "./lab";
import { seriousViolations } from "./serious-violations";

test("cursors and figures are those of the sine that is played, and the picture can be kept", async ({
  page,
  openBench,
}) => {
  await openBench("lab");
  await expect(page.locator(SCOPE_CANVAS).first()).toBeVisible();
  const scope = page.getByRole("region", { name: /^Scope: reference.voltage/ });
  await scope.getByRole("button", { name: "Measure" }).click();
  const figures = scope.getByRole("region", { name: "Measurements" });
  const row = figures.getByRole("row", { name: /drive voltage/ });
  // the first look plays 10 V at 2 kHz, and in open loop the drive is the reference
  await expect(row.getByRole("cell").nth(3)).toHaveText(/^7\.0[67]\d*\sV$/);
  await expect(row.getByRole("cell").nth(5)).toHaveText(/^(2\.000|1\.999|2\.001)\skHz$/);
  await expect(row.getByRole("cell").nth(8)).toHaveText(/^−?0\.\d°$/);
  await expect(row.getByRole("cell").nth(9)).toHaveText("1.000");
  await expect(figures.getByText("2.000 ms")).toBeVisible();

  const b = scope.getByRole("slider", { name: "Cursor B" });
  await b.focus();
  for (let i = 0; i < 25; i += 1) await b.press("ArrowLeft");
  // 25 of 100 of a window of 4 ms
  await expect(figures.getByText("1.000 ms")).toBeVisible();
  await expect(figures.getByText("1.000 kHz")).toBeVisible();
  await page.getByRole("button", { name: "Pause" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await seriousViolations(page).then((found) => expect(found).toEqual([]));

  const save = async (kind: string) => {
    await scope.getByRole("button", { name: "Export" }).click();
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
