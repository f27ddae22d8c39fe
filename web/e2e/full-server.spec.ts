import { expect, test } from "@playwright/test";
import { LabServer } from "./lab-server";
import { expectFits } from "./screens";
import { seriousViolations } from "./serious-violations";

test("a full server says what to do; a bench it let go is there again when its page comes back", async ({ page }) => {
  const server = await LabServer.create({ COMBBENCH_MAX_BENCHES: "1", COMBBENCH_IDLE_MINUTES: "0.001" });
  try {
    const { id: first } = await server.ask<{ id: string }>("POST", "/benches", { scenario: "first-look", keep: true });
    await page.goto(server.url);
    await expect(page.getByRole("heading", { name: "This server has no free bench" })).toBeVisible();
    await expect(page.getByText("wait until somebody closes one")).toBeVisible();
    expect(await seriousViolations(page)).toEqual([]);
    await expectFits(page, "a full server");
    await page.getByRole("button", { name: /^Join / }).click();
    await expect(page.getByTestId("bench-state")).toHaveText("running");

    await page.goto(server.origin);
    await expect(page.getByRole("button", { name: "Try again" })).toBeVisible();
    await server.ask("DELETE", `/benches/${first}`);
    await page.getByRole("button", { name: "Try again" }).click();
    await expect(page.getByTestId("bench-state")).toHaveText("running");

    await page.getByRole("button", { name: "Pause" }).click();
    await expect(page.getByTestId("bench-state")).toHaveText("paused");
    const address = page.url();
    const id = new URL(address).searchParams.get("bench");
    const { tick } = await server.ask<{ tick: number }>("GET", `/benches/${id}`);
    const shownTick = async () =>
      Number((await page.getByRole("timer", { name: "Device time" }).locator("small").innerText()).replace(/\D/g, ""));
    await expect.poll(shownTick).toBe(tick);
    await page.goto("about:blank");
    const benches = () => server.ask<{ benches: unknown[] }>("GET", "/benches");
    await expect.poll(async () => (await benches()).benches.length).toBe(0);
    await page.goto(address);
    await expect(page.getByText("Opened again as it was")).toBeVisible();
    await expect(page.getByTestId("bench-state")).toHaveText("paused");
    await expect.poll(shownTick).toBe(tick);
  } finally {
    await server.destroy();
  }
});
