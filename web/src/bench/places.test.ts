import { beforeEach, describe, expect, it, vi } from "vitest";
import { addressOf, type Place, placeOf } from "./places";

const PLACES: [string, Place][] = [
  ["", { page: "bench", item: "" }],
  ["class", { page: "class", item: "" }],
  ["gallery", { page: "gallery", item: "" }],
  ["gallery/ch5-seven-step", { page: "gallery", item: "ch5-seven-step" }],
  ["runs", { page: "runs", item: "" }],
  ["runs/a1", { page: "runs", item: "a1" }],
  ["runs/a1,b2", { page: "runs", item: "a1,b2" }],
  ["scores", { page: "benchmark", item: "" }],
  ["design", { page: "designer", item: "" }],
  ["design/lcr-350", { page: "designer", item: "lcr-350" }],
  ["theory", { page: "theory", item: "" }],
  ["theory/5.2.3.2", { page: "theory", item: "5.2.3.2" }],
  ["theory/gain%20%2F%20MRAC%20100%25", { page: "theory", item: "gain / MRAC 100%" }],
];

describe.each(["https://lab/", "https://lab/bench/", "https://lab/a/b/"])("below %s", (root) => {
  beforeEach(() => void vi.stubGlobal("document", { baseURI: root }));

  it.each(PLACES)("the path /%s is a place, and the address of that place", (path, place) => {
    expect(placeOf(new URL(`${root}${path}?bench=b7&layout=lab#x`))).toEqual(place);
    expect(addressOf(place)).toBe(root + path);
  });

  it.each([
    "nowhere",
    "bench",
    "gallery/",
    "gallery/a/b",
    "scores/1",
    "class/x",
    "Gallery",
    "/gallery",
    "index.html",
  ])("the path /%s is no place", (path) => {
    expect(placeOf(new URL(root + path))).toBeUndefined();
  });

  it("a lone percent sign is taken as it is", () => {
    expect(placeOf(new URL(`${root}theory/100%`))).toEqual({ page: "theory", item: "100%" });
  });

  it.each([
    ["?page=gallery", { page: "gallery", item: "" }],
    ["?page=benchmark&bench=b7", { page: "benchmark", item: "" }],
    ["?page=designer", { page: "designer", item: "" }],
    ["?page=runs&run=a1", { page: "runs", item: "a1" }],
    ["?page=runs&sweep=b2", { page: "runs", item: "b2" }],
    ["?page=runs&compare=a1%2Cb2", { page: "runs", item: "a1,b2" }],
    ["?page=nonsense", { page: "bench", item: "" }],
    ["?link=ab3kmn7x", { page: "bench", item: "" }],
    ["lti?layout=lab", { page: "bench", item: "" }],
  ])("an address of an earlier version, %s, opens its place", (path, place) => {
    expect(placeOf(new URL(root + path))).toEqual(place);
  });
});
