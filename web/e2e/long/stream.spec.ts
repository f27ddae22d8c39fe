import { expect, test } from "../lab";

test("a hidden page stays connected although it draws nothing and its timers are paused", async ({
  page,
  server,
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
  const clock = page.getByRole("timer", { name: "Device time" });
  const before = await clock.innerText();
  await goAway(true);
  await server.advance(8); // the server disconnects a page that takes nothing for 5 s
  await goAway(false);
  await server.advance(1);
  await expect(clock).not.toHaveText(before);
  expect(streams).toHaveLength(1);
});
