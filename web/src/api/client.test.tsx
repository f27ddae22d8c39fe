import { expect, it } from "vitest";
import { server } from "../testing/fake-server";
import { api } from "./api";

const recording = (id: number) => ({ id: `r${id}` });

/** Answers with pages of two of five recordings, as a server below the path of a proxy. */
function pages({ query }: { query: Record<string, string> }): Response {
  const first = Number(query.after ?? 0);
  const next = `<https://lab.example/bench/api/v1/recordings?limit=2&after=${first + 2}>; rel="next"`;
  const recordings = [0, 1, 2, 3, 4].slice(first, first + 2).map(recording);
  return Response.json({ recordings, runs: recordings }, { headers: first < 4 ? { Link: next } : {} });
}

it("reads a list on all its pages", async () => {
  server.on("GET", "/recordings", pages);
  expect(await api.recordings()).toEqual([0, 1, 2, 3, 4].map(recording));
  expect(server.asked("GET", "/recordings").map((asked) => asked.query.after)).toEqual([undefined, "2", "4"]);
});

it("reads no more pages of a long list than are wanted, and tells whether rows are left", async () => {
  server.on("GET", "/runs", pages);
  expect(await api.newestRuns({ text: "x" }, 3)).toEqual({ rows: [0, 1, 2, 3].map(recording), isWhole: false });
  expect(server.asked("GET", "/runs").map((asked) => asked.query)).toEqual([
    { text: "x", limit: "3" },
    { text: "x", limit: "3", after: "2" },
  ]);
  expect((await api.newestRuns({}, 9)).isWhole).toBe(true);
});
