import type { Page } from "@playwright/test";
import { benchOf } from "../classroom";
import { expect, test } from "../lab";
import { sceneAtRest, sceneOf, sceneShown } from "../scene";

/** WebGL drawn in software. */
test.use({
  drawn: true,
  launchOptions: {
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  },
});

/** The middle of the field of the first scope, and its ends. */
async function fieldOf(page: Page) {
  const box = await page
    .getByRole("region", { name: /^Scope: / })
    .first()
    .getByTestId("field")
    .boundingBox();
  if (!box) throw new Error("no scope is drawn");
  return { x: (share: number) => box.x + share * box.width, y: box.y + box.height / 2 };
}

test("under the pointer the device in 3D shows that moment, and it comes back when the pointer leaves", async ({
  page,
  openBench,
  server,
}) => {
  await openBench("research");
  const bench = benchOf(page);
  await server.advance(4);
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  const caption = sceneOf(page).contentFrame().locator("#caption");
  const moment = caption.locator("b");
  await expect(caption).toContainText("motion ×");
  await page.mouse.move(4, 4);
  const shown = () => sceneShown(page);
  const now = await sceneAtRest(page);
  await expect(moment).toBeHidden();

  const { x, y } = await fieldOf(page);
  await page.mouse.move(x(0.31), y);
  await expect(moment).toHaveText(/^at \d+\.\d{3}\sms$/);
  const then = await sceneAtRest(page);
  expect(then).not.toBe(now);
  const first = await moment.textContent();
  await page.mouse.move(x(0.62), y);
  await expect(moment).not.toHaveText(first ?? "");
  expect(await sceneAtRest(page)).not.toBe(then);
  await page.mouse.move(x(0.31), y);
  await expect(moment).toHaveText(first ?? "");
  await expect.poll(shown).toBe(then);

  await page.mouse.move(4, 4);
  await expect(moment).toBeHidden();
  await expect.poll(shown).toBe(now);

  // a fault that came later is not on the device of before, and is back when the pointer leaves
  await server.ask("POST", `/benches/${bench}/commands`, { fault: "added_mass", severity: 0.3 });
  await server.ask("POST", `/benches/${bench}/commands`, { kind: "step", ticks: 3 });
  await expect.poll(shown).not.toBe(now);
  await page.mouse.move(x(0.31), y);
  await expect(moment).toBeVisible();
  await page.mouse.move(4, 4);
  await expect(moment).toBeHidden();
});
