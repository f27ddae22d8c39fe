import { at, client, data, every } from "./client";
import type { NewVote } from "./types";

const ofVote = (vote_id: string) => at({ vote_id });

/** The REST calls around votes. */
export const votes = {
  all: () => every("votes", (query) => client.GET("/api/v1/votes", { params: { query } })),
  open: (body: NewVote) => data(client.POST("/api/v1/votes", { body })),
  close: (id: string) => data(client.POST("/api/v1/votes/{vote_id}/close", ofVote(id))),
  reveal: (id: string) => data(client.POST("/api/v1/votes/{vote_id}/reveal", ofVote(id))),
  count: (id: string, counts: number[]) =>
    data(client.PUT("/api/v1/votes/{vote_id}/hands", { ...ofVote(id), body: { counts } })),
  remove: (id: string) => data(client.DELETE("/api/v1/votes/{vote_id}", ofVote(id))),
};
