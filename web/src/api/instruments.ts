import { client, data, every } from "./client";

/** The REST calls around instruments that send their samples. */
export const instruments = {
  all: () => every("instruments", (query) => client.GET("/api/v1/instruments", { params: { query } })),
  open: (name: string, scenario: string, device = "") =>
    data(client.POST("/api/v1/instruments/{name}/benches", { params: { path: { name } }, body: { scenario, device } })),
};
