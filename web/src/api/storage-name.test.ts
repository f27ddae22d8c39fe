import { expect, it } from "vitest";
import { storageName } from "./storage-name";

it("keeps what belongs to one server apart from the servers below other paths", () => {
  const names = ["/", "/a/", "/b/", "/a/b/"].map((path) => storageName("combbench.lecture", path));
  expect(new Set(names).size).toBe(4);
  expect(storageName("combbench.lecture")).toBe("combbench.lecture");
});
