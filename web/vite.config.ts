import { globSync, readFileSync } from "node:fs";
import react from "@vitejs/plugin-react";
import { compression } from "vite-plugin-compression2";
import { defineConfig } from "vitest/config";

/** Where `npm run dev` finds the board; the built page is served by the board itself. */
const board = process.env.COMBBENCH_URL ?? "http://127.0.0.1:8000";

/** Files of tests that replace a module for themselves need modules of their own; the others share theirs. */
const replacing = globSync("src/**/*.test.{ts,tsx}", { cwd: import.meta.dirname }).filter((file) =>
  readFileSync(`${import.meta.dirname}/${file}`, "utf8").includes("vi.mock("),
);

const views = {
  testTimeout: 60_000, // a busy machine takes its time
  environment: "jsdom",
  setupFiles: ["src/testing/setup.ts"],
};

export default defineConfig({
  // All addresses are relative to the base of the page, so that a proxy may serve it under any path.
  base: "./",
  plugins: [
    react(),
    // The board serves these instead: a class that opens the page over one wireless network waits for a third of it.
    compression({ algorithms: ["gzip"], include: /\.(js|css|svg)$/, skipIfLargerOrEqual: true }),
  ],
  server: {
    host: "127.0.0.1",
    fs: { allow: [".", ...["report", "library", "lectures"].map((name) => `../scenarios/${name}`)] },
    proxy: {
      "/api": { target: board, ws: true },
      "/benches": { target: board, ws: true },
    },
  },
  build: {
    outDir: "dist",
    rolldownOptions: {
      output: {
        codeSplitting: {
          groups: [
            { name: "katex", test: /node_modules[\\/]katex/ },
            { name: "dock", test: /node_modules[\\/]dockview/ },
            { name: "codemirror", test: /node_modules[\\/](@codemirror|@lezer|@marijn|style-mod|w3c-keyname|crelt)/ },
            { name: "mantine", test: /node_modules[\\/]@(mantine|floating-ui)/ },
            { name: "vendor", test: /node_modules/ },
          ],
        },
      },
    },
  },
  test: {
    outputFile: { junit: process.env.VITEST_JUNIT ?? "test-results/page.xml" },
    projects: [
      { extends: true, test: { name: "units", include: ["src/**/*.test.ts"], exclude: replacing, isolate: false } },
      {
        extends: true,
        test: { name: "views", ...views, include: ["src/**/*.test.tsx"], exclude: replacing, isolate: false },
      },
      { extends: true, test: { name: "replacing", ...views, include: replacing } },
    ],
  },
});
