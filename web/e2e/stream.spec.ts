import { expect, pictureOf, SCOPE_CANVAS, test } from "./lab";

test("a first visit opens a bench that is already running", async ({ page, server }) => {
  const started = Date.now();
  await page.goto(server.url);
  await expect(page.getByTestId("bench-state")).toHaveText("running", { timeout: 15_000 });
  await expect(page.getByText("Try this:")).toBeVisible();
  await expect(page.locator(SCOPE_CANVAS).first()).toBeVisible();
  expect(page.url()).not.toContain("token");
  console.log(`first visit: running after ${Date.now() - started} ms`);
});

test("traces move, device time runs, and pausing stops both", async ({ page, openBench }) => {
  await openBench();
  const clock = page.getByRole("timer", { name: "Device time" });
  const before = await clock.innerText();
  await expect.poll(() => clock.innerText()).not.toBe(before);
  const picture = await pictureOf(page, SCOPE_CANVAS);
  await expect.poll(() => pictureOf(page, SCOPE_CANVAS)).not.toBe(picture);

  await page.keyboard.press(" ");
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await page.waitForTimeout(500);
  const stopped = await clock.innerText();
  await page.keyboard.press(".");
  await expect.poll(() => clock.innerText()).not.toBe(stopped);
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
});

test("time scale doubles and halves by key, target and achieved side by side", async ({ page, openBench }) => {
  await openBench();
  const scale = page.getByRole("group", { name: "Time scale" });
  await page.keyboard.press("]");
  await expect(scale.getByRole("button", { name: /^4\.00/ })).toBeVisible();
  await expect(scale.getByText(/runs (4\.0|3\.9)\d\sms\/s/)).toBeVisible();
  await page.keyboard.press("[");
  await expect(scale.getByRole("button", { name: /^2\.00/ })).toBeVisible();
});

test("looking back does not stop the board, and LIVE returns", async ({ page, openBench }) => {
  await openBench();
  await page.waitForTimeout(2500);
  const clock = page.getByRole("timer", { name: "Device time" });
  const scope = page.locator("section[aria-label^='Scope']").first();
  await scope.getByLabel(/^Plot/).focus();
  await page.keyboard.press("ArrowLeft");
  await expect(scope.getByRole("button", { name: "LIVE" })).toHaveAttribute("aria-pressed", "false");
  await expect(scope.getByRole("button", { name: "LIVE" })).toContainText("PAST");
  // the picture of the past may take a while to come; once it is there it stays while the clock goes on
  let still = "";
  const stands = async () => {
    const before = still;
    still = await pictureOf(page, SCOPE_CANVAS);
    return still === before;
  };
  await expect.poll(stands, { intervals: [700] }).toBe(true);
  const time = await clock.innerText();
  await page.waitForTimeout(700);
  await expect.poll(() => clock.innerText()).not.toBe(time);
  expect(await pictureOf(page, SCOPE_CANVAS)).toBe(still);
  await expect(page.getByTestId("bench-state")).toHaveText("running");

  const box = await scope.locator("canvas").boundingBox();
  if (!box) throw new Error("the scope has no place");
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.wheel(0, -400);
  await expect.poll(() => pictureOf(page, SCOPE_CANVAS)).not.toBe(still);

  await scope.getByRole("button", { name: "LIVE" }).click();
  await expect(scope.getByRole("button", { name: "LIVE" })).toHaveAttribute("aria-pressed", "true");
  const live = await pictureOf(page, SCOPE_CANVAS);
  await expect.poll(() => pictureOf(page, SCOPE_CANVAS)).not.toBe(live);
  await page.getByRole("button", { name: /^Pause/ }).click();
  await expect(scope.getByRole("button", { name: "LIVE, PAUSED" })).toBeVisible();
});

test("a hidden page stays connected although it draws nothing and its timers stand still", async ({
  page,
  openBench,
}) => {
  const streams: string[] = [];
  page.on("websocket", (socket) => socket.url().includes("/stream") && streams.push(socket.url()));
  await page.addInitScript(() => {
    const hidden = () => (window as unknown as { away?: boolean }).away === true;
    Object.defineProperty(document, "hidden", { get: hidden });
    const frame = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (draw) =>
      frame((now) => (hidden() ? window.requestAnimationFrame(draw) : draw(now)));
    const repeat = window.setInterval.bind(window) as (run: () => void, ms?: number) => number;
    window.setInterval = ((run: () => void, ms?: number) =>
      repeat(() => hidden() || run(), ms)) as typeof window.setInterval;
  });
  await openBench();
  const goAway = (away: boolean) =>
    page.evaluate((value) => {
      (window as unknown as { away?: boolean }).away = value;
    }, away);
  await goAway(true);
  await page.waitForTimeout(8000); // the server lets go of who takes nothing for 5 s
  await goAway(false);
  const clock = page.getByRole("timer", { name: "Device time" });
  const before = await clock.innerText();
  await expect.poll(() => clock.innerText()).not.toBe(before);
  expect(streams).toHaveLength(1);
});

test("a trigger holds the picture at an edge", async ({ page, openBench }) => {
  await openBench();
  const scope = page.locator("section[aria-label^='Scope']").first();
  await scope.getByRole("button", { name: "Trigger" }).click();
  await expect(scope.getByRole("button", { name: /● ↗ 0\sV/ })).toBeVisible();
  await scope.getByRole("button", { name: /● ↗ 0\sV/ }).click();
  await page.getByRole("combobox", { name: "When it" }).selectOption("leaves");
  await page.getByRole("textbox", { name: "From" }).fill("-5");
  await page.getByRole("textbox", { name: "To" }).fill("5");
  await expect(scope.getByRole("button", { name: /● ⇤ −5\sV to 5\sV/ })).toBeVisible();
});
