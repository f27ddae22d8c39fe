import type { Locator } from "@playwright/test";
import { expect, pictureOf, SCOPE_CANVAS, test } from "./lab";
import { seriousViolations } from "./serious-violations";

/** What a scope draws, read from its own canvas: rows with the axis' numbers below, rows the traces cover. */
async function drawn(scope: Locator): Promise<{ below: number; traces: number; height: number }> {
  const field = await scope.locator(".u-over").boundingBox();
  const panel = await scope.boundingBox();
  if (!field || !panel) throw new Error("nothing is drawn");
  const traces = await scope.locator("canvas").evaluate((canvas: HTMLCanvasElement) => {
    const context = canvas.getContext("2d") as CanvasRenderingContext2D;
    const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
    let [first, last] = [canvas.height, 0];
    for (let y = 0; y < canvas.height; y += 1)
      for (let x = Math.round(canvas.width * 0.1); x < canvas.width * 0.9; x += 1) {
        const at = 4 * (y * canvas.width + x);
        const [r, g, b] = [data[at], data[at + 1], data[at + 2]];
        if (data[at + 3] < 128 || Math.max(r, g, b) - Math.min(r, g, b) < 60) continue; // grid and text are grey
        first = Math.min(first, y);
        last = Math.max(last, y);
      }
    return (last - first) * (canvas.clientHeight / canvas.height);
  });
  return { below: panel.y + panel.height - (field.y + field.height), traces, height: panel.height };
}

test("at first sight every scope has its axis, one row of names, and traces that fill it", async ({
  page,
  openBench,
}) => {
  await page.setViewportSize({ width: 1366, height: 768 });
  await openBench("research");
  for (const key of ["3", "2", "1"]) {
    await page.keyboard.press(key);
    const scopes = page.getByRole("region", { name: /^Scope: / });
    await expect(scopes).toHaveCount(key === "1" ? 1 : 2);
    // all at once: the layout before may still be there
    for (const scope of await scopes.all())
      await expect(async () => {
        await expect(scope.locator(".u-over")).toBeInViewport({ ratio: 1, timeout: 1000 });
        const room = await drawn(scope);
        expect(room.below).toBeGreaterThan(15); // the axis of time
        expect(room.traces / room.height).toBeGreaterThan(0.4);
        const names = await scope.getByRole("list", { name: "Signals" }).boundingBox();
        expect(names?.height).toBeLessThan(30);
        expect(await scope.evaluate((panel) => panel.scrollHeight <= panel.clientHeight)).toBe(true);
      }).toPass();
  }
});

test("names that have no room are behind a button, the tracking error is a scope, a band says it is one", async ({
  page,
  openBench,
}) => {
  await page.setViewportSize({ width: 1366, height: 768 });
  await openBench("research", { "controller.kind": "pid" });
  const motion = page.getByRole("region", { name: /^Scope: plant\.displacement/ });
  await motion.getByRole("button", { name: /^\+\d$/ }).click();
  const others = page.getByRole("list", { name: "Other signals" });
  await expect(others.getByText(/^model/)).toBeVisible();
  await expect(others.getByRole("listitem").last()).toContainText("µm");
  await page.keyboard.press("Escape");

  await expect(motion.getByRole("note")).toBeHidden();
  await motion.getByRole("combobox", { name: "Time window" }).selectOption("500");
  const note = motion.getByRole("note", { name: /^envelope: Each pixel takes [\d.]+\s[µm]?s, \d+\ssamples\./ });
  await expect(note).toBeVisible();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
  await motion.getByRole("combobox", { name: "Time window" }).selectOption("4");
  await expect(note).toBeHidden();

  await page.getByRole("tab", { name: "Tracking error" }).click();
  const error = page.getByRole("region", { name: "Scope: model.tracking_error" });
  await expect(error.getByRole("list", { name: "Signals" })).toContainText(/model tracking error\s*−?[\d.]+\s[nµ]m/);
});

test("a scope has a logarithmic scale, which stays with the layout", async ({ page, openBench }) => {
  await openBench("lab");
  const scope = page.getByRole("region", { name: /^Scope: plant.displacement/ });
  await expect.poll(async () => (await drawn(scope)).traces).toBeGreaterThan(10);
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  const picture = () => pictureOf(page, SCOPE_CANVAS);
  const before = await picture();
  const choose = async () => {
    await scope.getByRole("button", { name: "Choose signals" }).click();
    return page.getByRole("checkbox", { name: "Logarithmic scale, of magnitudes" });
  };
  await (await choose()).check();
  await page.keyboard.press("Escape");
  await expect.poll(picture).not.toBe(before);
  await page.waitForTimeout(900);
  await page.reload();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await expect(await choose()).toBeChecked();
});
