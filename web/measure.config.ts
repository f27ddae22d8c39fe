import { defineConfig } from "@playwright/test";
import tests from "./playwright.config";

process.env.FRAME_RATE_HZ = "60";
process.env.CLOCK = "machine"; // benches run by themselves

/** How fast the page is: measured by hand on a quiet machine (`make page-speed`), never a test of a suite. */
export default defineConfig({
  ...tests,
  testDir: "measure",
  testMatch: "*.measure.ts",
  workers: 1,
  timeout: 60 * 60_000,
});
