import { expect, test } from "vitest";
import { qrPath } from "./qr-code";

/** The rows of a code, dark as "#". */
function drawn(text: string): string[] {
  const { path, size } = qrPath(text);
  const rows = Array.from({ length: size }, () => Array<string>(size).fill("."));
  for (const [, x, y] of path.matchAll(/M(\d+) (\d+)h1v1h-1z/g)) rows[Number(y)][Number(x)] = "#";
  return rows.map((row) => row.join(""));
}

test("a code has its three finders, four light modules around it, and the next size when it must", () => {
  const rows = drawn("lab.example");
  expect(rows.length).toBe(21 + 8);
  const finder = ["#######", "#.....#", "#.###.#", "#.###.#", "#.###.#", "#.....#", "#######"];
  const corner = (x: number, y: number) => rows.slice(y, y + 7).map((row) => row.slice(x, x + 7));
  for (const [x, y] of [
    [4, 4],
    [18, 4],
    [4, 18],
  ])
    expect(corner(x, y)).toEqual(finder);
  const quiet = [...rows.slice(0, 4), ...rows.slice(-4), ...rows.map((row) => row.slice(0, 4) + row.slice(-4))];
  expect(quiet.join("")).not.toContain("#");
  expect(drawn(`https://lab.example/bench/?link=${"x".repeat(60)}`).length).toBeGreaterThan(rows.length);
});
