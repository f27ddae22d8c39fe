import { at, client, data } from "./client";

/** The REST calls of a lecture. */
export const lectures = {
  all: async () => (await data(client.GET("/api/v1/lectures"))).lectures,
  get: (lecture_id: string) => data(client.GET("/api/v1/lectures/{lecture_id}", at({ lecture_id }))),
  /** Put a bench into the state of a cue, counted from 1; without one, or where it has other signals, a fresh one. */
  put: (lecture_id: string, number: number, bench: string | null) =>
    data(
      client.POST("/api/v1/lectures/{lecture_id}/cues/{number}", {
        ...at({ lecture_id, number }),
        body: { bench },
      }),
    ),
};
