import { expect, test } from "@playwright/test";
import { LabServer } from "./lab-server";

test("a hidden page stays connected; a page outlives its server and continues when it is back", async ({ page }) => {
  const server = await LabServer.create();
  try {
    const closed: string[] = [];
    page.on("websocket", (socket) => socket.on("close", () => closed.push(socket.url())));
    await page.request.get(server.url);
    await page.goto(`${server.origin}/?layout=lab`);
    const state = page.getByTestId("bench-state");
    const clock = page.getByRole("timer", { name: "Device time" });
    await expect(state).toHaveText("running");

    // a hidden page draws nothing, and a browser asks it for no frame
    await page.evaluate(() => {
      Object.defineProperty(document, "hidden", { get: () => true });
      Object.defineProperty(document, "visibilityState", { get: () => "hidden" });
      window.requestAnimationFrame = () => 0;
      document.dispatchEvent(new Event("visibilitychange"));
    });
    for (let second = 0; second < 8; second += 1) {
      const before = await clock.innerText();
      await server.advance(1);
      await expect(clock).not.toHaveText(before);
    }
    await expect(state).toHaveText("running");
    expect(closed).toEqual([]); // the server closes a stream from which nothing is taken for 5 s
    await page.reload();
    await expect(state).toHaveText("running");

    await server.stop();
    await expect(state).toHaveText("reconnecting");
    await expect(page.getByRole("region", { name: "Notice" }).getByText("Connection lost")).toBeVisible();
    await expect(page.getByRole("button", { name: "Try now" })).toBeVisible();
    await server.start();
    await page.request.get(server.url);
    await expect(state).toHaveText("running"); // its bench is back, and no other
    const stopped = await clock.innerText();
    await server.advance(1);
    await expect(clock).not.toHaveText(stopped);

    await server.ask("DELETE", `/benches/${new URL(page.url()).searchParams.get("bench")}`);
    await expect(state).toHaveText("not connected");
    await expect(page.getByRole("button", { name: "Run", exact: true })).toBeDisabled();
    await expect(page.getByTitle(/watching/)).toHaveCount(0);
    await page.getByRole("button", { name: "Start it again" }).click();
    await expect(state).toHaveText("running");
    const before = await clock.innerText();
    await server.advance(1);
    await expect(clock).not.toHaveText(before);
  } finally {
    await server.destroy();
  }
});

test("a full server shows the next step, and a closed idle bench opens again unchanged", async ({ page }) => {
  const server = await LabServer.create({ COMBBENCH_MAX_BENCHES: "1", COMBBENCH_IDLE_MINUTES: "0.001" });
  const benches = () => server.ask<{ benches: { watchers: number }[] }>("GET", "/benches").then((all) => all.benches);
  try {
    const { id: first } = await server.ask<{ id: string }>("POST", "/benches", { scenario: "first-look", keep: true });
    await page.goto(server.url);
    await expect(page.getByRole("heading", { name: "This server has no free bench" })).toBeVisible();
    await expect(page.getByText("Wait until one is closed")).toBeVisible();
    await page.getByRole("button", { name: /^Join / }).click();
    await expect(page.getByTestId("bench-state")).toHaveText("running");

    await page.goto(server.origin);
    await expect(page.getByRole("button", { name: "Try again" })).toBeVisible();
    await server.ask("DELETE", `/benches/${first}`);
    await page.getByRole("button", { name: "Try again" }).click();
    await expect(page.getByTestId("bench-state")).toHaveText("running");
    await server.advance(1);
    await page.getByRole("button", { name: "Pause" }).click();
    await expect(page.getByTestId("bench-state")).toHaveText("paused");
    const address = page.url();
    const { tick } = await server.ask<{ tick: number }>(
      "GET",
      `/benches/${new URL(address).searchParams.get("bench")}`,
    );
    expect(tick).toBeGreaterThan(0);
    const shownTick = async () =>
      Number((await page.getByRole("timer", { name: "Device time" }).locator("small").innerText()).replace(/\D/g, ""));
    await expect.poll(shownTick).toBe(tick);

    await page.goto("about:blank");
    await expect.poll(async () => (await benches()).every(({ watchers }) => watchers === 0)).toBe(true);
    await server.advance(11); // benches are looked at every 5 s
    await expect.poll(async () => (await benches()).length).toBe(0);
    await page.goto(address);
    await expect(page.getByText("Opened again as it was")).toBeVisible();
    await expect(page.getByTestId("bench-state")).toHaveText("paused");
    await expect.poll(shownTick).toBe(tick);
  } finally {
    await server.destroy();
  }
});
