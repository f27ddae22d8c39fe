import { at, client, data } from "./client";
import type { HandedIn } from "./types";

const ofGame = (game_id: string, seed: number) => at({ game_id }, { seed });
const toGame = (game_id: string, body: { seed: number; hand_in: HandedIn }) => ({ ...at({ game_id }), body });

/** The REST calls around games. */
export const games = {
  all: async () => (await data(client.GET("/api/v1/games"))).games,
  of: (game: string, seed: number) => data(client.GET("/api/v1/games/{game_id}", ofGame(game, seed))),
  begin: (game: string, seed: number, hand_in: HandedIn) =>
    data(client.POST("/api/v1/games/{game_id}/begin", toGame(game, { seed, hand_in }))),
  handIn: (game: string, seed: number, hand_in: HandedIn) =>
    data(client.POST("/api/v1/games/{game_id}/attempts", toGame(game, { seed, hand_in }))),
  reveal: (game: string, seed: number) =>
    data(client.POST("/api/v1/games/{game_id}/reveal", { ...at({ game_id: game }), body: { seed } })),
  ofClass: (class_id: string, game_id: string, seed: number) =>
    data(client.GET("/api/v1/classes/{class_id}/games/{game_id}", at({ class_id, game_id }, { seed }))),
};
