import { expect, test } from "@playwright/test";
import { LabServer } from "./lab-server";

test("the page outlives its server and goes on when it is back", async ({ page }) => {
  const server = await LabServer.create();
  try {
    await page.request.get(server.url);
    await page.goto(`${server.origin}/?layout=lab`);
    await expect(page.getByTestId("bench-state")).toHaveText("running");

    await server.stop();
    await expect(page.getByTestId("bench-state")).toHaveText("reconnecting");
    await expect(page.getByRole("region", { name: "Notice" }).getByText("Connection lost")).toBeVisible();
    await expect(page.getByRole("button", { name: "Try now" })).toBeVisible();

    await server.start();
    await page.request.get(server.url);
    await expect(page.getByTestId("bench-state")).toHaveText("not connected", { timeout: 120_000 });
    await expect(page.getByRole("button", { name: "Run", exact: true })).toBeDisabled();
    await expect(page.getByText("watching")).toHaveCount(0);
    await page.getByRole("button", { name: "Start it again" }).click({ timeout: 120_000 });
    await expect(page.getByTestId("bench-state")).toHaveText("running");
    const clock = page.getByRole("timer", { name: "Device time" });
    const before = await clock.innerText();
    await expect.poll(() => clock.innerText()).not.toBe(before);
  } finally {
    await server.destroy();
  }
});
