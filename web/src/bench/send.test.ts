import { afterEach, expect, test, vi } from "vitest";
import { useMe } from "../api/me";
import type { Me } from "../api/types";
import { send } from "./send";

const command = vi.hoisted(() => vi.fn(async () => 7));
vi.mock("../stream/stream", () => ({ stream: { client: { command } } }));

const be = (role: Me["role"]) =>
  useMe.setState({ me: { id: role, role, name: role, bench: "b", class_id: null, hand: false } });

afterEach(() => command.mockClear());

test("a command is sent for a teacher and for a student, and never for a watcher", async () => {
  for (const role of ["teacher", "student"] as const) {
    be(role);
    expect(await send({ kind: "pause" })).toBe(true);
  }
  expect(command).toHaveBeenCalledTimes(2);
  be("watcher");
  expect(await send({ kind: "pause" })).toBe(false);
  expect(command).toHaveBeenCalledTimes(2);
});
