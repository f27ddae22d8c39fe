import { defineConfig } from "@playwright/test";

/** Two browsers, each with a server of its own. The journeys are the short suite; the folder `long` belongs to the long one. */
export default defineConfig({
  testDir: "e2e",
  testIgnore: process.env.SUITE === "all" ? [] : ["long/**"],
  timeout: 120_000,
  expect: { timeout: 30_000 },
  workers: 2,
  fullyParallel: false,
  retries: 0,
  reporter: [["list"]],
  use: {
    viewport: { width: 1440, height: 900 },
    // a trace would take as much of the machine as the test; `--trace on` makes one of a test that failed
    screenshot: "only-on-failure",
    launchOptions: {
      executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
      args: ["--no-sandbox", "--disable-gpu"],
    },
  },
});
