import { defineConfig } from "@playwright/test";

/** Two browsers, each with a server of its own: they mostly wait, and each board shares the machine with a WebGL drawn in software. */
export default defineConfig({
  testDir: "e2e",
  timeout: 400_000,
  expect: { timeout: 60_000 },
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
      args: [
        "--no-sandbox",
        "--disable-gpu",
        "--use-gl=angle",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--ignore-gpu-blocklist",
      ],
    },
  },
});
