import { at, client, data } from "./client";

const unit = (name: string) => at({ name });

/** The REST calls around the user's own units. */
export const units = {
  all: () => data(client.GET("/api/v1/units")),
  text: (name: string) => data(client.GET("/api/v1/units/{name}", unit(name))),
  check: (name: string, source: string) => data(client.POST("/api/v1/units", { body: { name, source } })),
  keep: (name: string, source: string) => data(client.PUT("/api/v1/units/{name}", { ...unit(name), body: { source } })),
  remove: (name: string) => data(client.DELETE("/api/v1/units/{name}", unit(name))),
};
