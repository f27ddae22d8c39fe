import { expect, pictureOf, SCOPE_CANVAS, test } from "./lab";
import { ProxyServer } from "./proxy-server";
import { sceneOf } from "./scene";

test.use({
  drawn: true,
  launchOptions: async ({ launchOptions }, use) => {
    await use({
      ...launchOptions,
      // each connection with a certificate of its own making would begin the request anew, until Chromium gives it up
      args: [
        ...(launchOptions.args ?? []),
        "--host-resolver-rules=MAP lab.example 127.0.0.1",
        "--ignore-certificate-errors",
      ],
    });
  },
});

for (const prefix of ["", "/bench"]) {
  test(`behind a proxy with TLS, at ${prefix || "/"}, everything on the page works`, async ({ page }) => {
    const proxy = await ProxyServer.create(prefix);
    const refused: string[] = [];
    page.on("response", (answer) => answer.status() >= 400 && refused.push(`${answer.status()} ${answer.url()}`));
    page.on("requestfailed", (request) => refused.push(`${request.failure()?.errorText} ${request.url()}`));
    try {
      const base = proxy.lab.url.replace(/\?.*/, "");
      await page.goto(proxy.lab.url);
      await expect(page).toHaveURL(new RegExp(`^${base}\\?bench=`));
      await expect(page.getByTestId("bench-state")).toHaveText("running");
      const cookies = await page.context().cookies();
      expect(cookies.map(({ secure, path }) => ({ secure, path }))).toEqual([{ secure: true, path: `${prefix}/` }]);

      const before = await pictureOf(page, SCOPE_CANVAS);
      await expect.poll(() => pictureOf(page, SCOPE_CANVAS)).not.toBe(before);

      const frame = sceneOf(page).contentFrame();
      const canvas = frame.locator("canvas").first();
      await expect(canvas).toBeVisible({ timeout: 120_000 });
      await expect(page.getByText("The 3D view is loading")).toBeHidden({ timeout: 120_000 });
      const drawn = async () => (await canvas.screenshot()).toString("base64");
      const first = await drawn();
      await expect.poll(drawn, { timeout: 120_000 }).not.toBe(first);

      await page.locator("body").press("Shift+S");
      await expect(page.getByRole("textbox", { name: "Link", exact: true })).toHaveValue(
        new RegExp(`^${base}\\?link=[2-9a-z]{8}$`),
      );
      await expect(page.getByText("cannot reach this address")).toHaveCount(0);

      expect(
        await page.locator("img[src='./comb.svg']").evaluate((img) => (img as HTMLImageElement).naturalWidth),
      ).toBeGreaterThan(0);
      expect(refused.filter((line) => !line.includes("ERR_ABORTED"))).toEqual([]);
    } finally {
      if (refused.length) console.log(`server said: ${refused.slice(0, 8).join("; ")}`);
      await proxy.destroy();
    }
  });
}
