import { afterEach, expect, test } from "vitest";
import { may, placeOf, useMe } from "./me";
import type { Me } from "./types";

const ADA: Me = { id: "a", role: "student", name: "Ada", bench: "own", class_id: "c", hand: false };

afterEach(() => useMe.setState({ me: undefined, at: undefined }));

test("a student goes where the teacher shows or hands over something, and home when that ends", () => {
  const shown = { ...ADA, shown: "s" };
  const lent = { ...ADA, lent: "t" };
  expect(placeOf(ADA, undefined, undefined)).toBe("own");
  expect(placeOf(shown, ADA, "own")).toBe("s");
  expect(placeOf(lent, ADA, "own")).toBe("t");
  expect(placeOf({ ...shown, lent: "t" }, shown, "s")).toBe("t");
  expect(placeOf(ADA, shown, "s")).toBe("own");
  expect(placeOf({ ...ADA, bench: "next" }, ADA, "own")).toBe("next");
});

test("a student who went home stays there until something else is shown", () => {
  const shown = { ...ADA, shown: "s" };
  expect(placeOf(shown, shown, "own")).toBeUndefined();
  expect(placeOf({ ...ADA, shown: "s2" }, shown, "own")).toBe("s2");
  expect(placeOf({ ...shown, hand: true }, shown, "s")).toBeUndefined();
});

test("a student drives the own bench and one that was handed over, and only looks at one that is shown", () => {
  const drives = (at: string, me: Partial<Me>) => {
    useMe.setState({ me: { ...ADA, ...me }, at });
    return may("drive");
  };
  expect(drives("own", { shown: "s" })).toBe(true);
  expect(drives("s", { shown: "s" })).toBe(false);
  expect(drives("s", { shown: "s", lent: "s" })).toBe(true);
  expect(drives("own", { shown: "own" })).toBe(true);
});
