// @vitest-environment jsdom
import { expect, test } from "vitest";
import { isLocal, joinAddress } from "./classes";

test("students join at the first address that the server knows of, else where the page is; or nowhere", () => {
  const path = "/join?code=k7m4x9p2tq";
  const addresses = ["http://192.168.1.20:8000/join?code=k7m4x9p2tq", "http://lab.local:8000/join?code=k7m4x9p2tq"];
  expect(joinAddress({ path, addresses })).toBe(addresses[0]);
  expect(joinAddress({ path, addresses: [] })).toBe(new URL("./join?code=k7m4x9p2tq", document.baseURI).href);
  expect(joinAddress({ path })).toBe(joinAddress({ path, addresses: [] }));
  expect(joinAddress({ path: null })).toBeUndefined();
});

test("an address for this machine alone is known", () => {
  for (const host of ["localhost", "127.0.0.1:8450", "127.1.2.3", "[::1]:8000"])
    expect(isLocal(`http://${host}/join`)).toBe(true);
  for (const host of ["192.168.1.20:8000", "lab.example", "127.example"])
    expect(isLocal(`http://${host}/join`)).toBe(false);
});
