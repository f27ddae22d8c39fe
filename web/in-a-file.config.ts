import { defineConfig } from "vite";

/** The page of a bench in a file: one script and one style sheet, which `combbench export` puts into each file. */
export default defineConfig({
  publicDir: false,
  define: { "process.env.NODE_ENV": '"production"' },
  build: {
    outDir: "dist/in-a-file",
    emptyOutDir: true,
    target: "es2023",
    lib: {
      entry: "src/in-a-file/main.ts",
      formats: ["iife"],
      name: "bench",
      fileName: () => "page.js",
      cssFileName: "page",
    },
  },
});
