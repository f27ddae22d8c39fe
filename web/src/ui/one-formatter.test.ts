import { expect, it } from "vitest";

/** Where numbers become text, and where they are rounded. */
const HERE = ["./format.ts", "./unit-scale.ts"];
const OTHER_WAYS = /\.(toFixed|toPrecision|toExponential)\(|\bIntl\.|(?<!Date\([^)]*\))\.toLocaleString\(/;

const sources = import.meta.glob<string>(["../**/*.{ts,tsx}", "!../**/*.{test,d}.{ts,tsx}"], {
  query: "?raw",
  import: "default",
  eager: true,
});

it("writes numbers in one place", () => {
  expect(Object.keys(sources).length).toBeGreaterThan(200);
  for (const here of HERE) expect(sources[here], here).toMatch(OTHER_WAYS);
  const astray = Object.keys(sources).filter((path) => !HERE.includes(path) && OTHER_WAYS.test(sources[path]));
  expect(astray).toEqual([]);
});
