import { client, data } from "./client";
import type { Command } from "./types";

/** The REST calls of a lecture. */
export const lectures = {
  all: async () => (await data(client.GET("/api/v1/lectures"))).lectures,
  get: (lecture_id: string) => data(client.GET("/api/v1/lectures/{lecture_id}", { params: { path: { lecture_id } } })),
  /** Put a bench into the state of a cue, counted from 1; without one, or where it has other signals, a fresh one. */
  put: (lecture_id: string, number: number, bench: string | null) =>
    data(
      client.POST("/api/v1/lectures/{lecture_id}/cues/{number}", {
        params: { path: { lecture_id, number } },
        body: { bench },
      }),
    ),
  /** Send a command to a bench that is not on the page. */
  command: (bench_id: string, command: Command) =>
    data(client.POST("/api/v1/benches/{bench_id}/commands", { params: { path: { bench_id } }, body: command })),
};
