import { at, client, data } from "./client";

const ofSheet = (sheet_id: string) => at({ sheet_id });
const ofStep = (sheet_id: string, step_id: string) => at({ sheet_id, step_id });

/** The REST calls around lab sheets. */
export const sheets = {
  all: () => data(client.GET("/api/v1/sheets")),
  get: (id: string) => data(client.GET("/api/v1/sheets/{sheet_id}", ofSheet(id))),
  begin: (id: string) => data(client.POST("/api/v1/sheets/{sheet_id}/begin", ofSheet(id))),
  open: (text: string) => data(client.POST("/api/v1/sheets", { body: { text } })),
  remove: (id: string) => data(client.DELETE("/api/v1/sheets/{sheet_id}", ofSheet(id))),
  startOver: (id: string) => data(client.DELETE("/api/v1/sheets/{sheet_id}/progress", ofSheet(id))),
  answer: (id: string, step: string, answer: string) =>
    data(client.POST("/api/v1/sheets/{sheet_id}/steps/{step_id}/answer", { ...ofStep(id, step), body: { answer } })),
  hide: (id: string, step: string) =>
    data(client.POST("/api/v1/sheets/{sheet_id}/steps/{step_id}/hide", ofStep(id, step))),
  hint: (id: string, step: string) =>
    data(client.POST("/api/v1/sheets/{sheet_id}/steps/{step_id}/hint", ofStep(id, step))),
  close: (id: string, step: string) =>
    data(client.POST("/api/v1/sheets/{sheet_id}/steps/{step_id}/close", ofStep(id, step))),
  keep: (sheet_id: string, recording_id: string) =>
    data(client.PUT("/api/v1/sheets/{sheet_id}/recordings/{recording_id}", at({ sheet_id, recording_id }))),
  forAll: (class_id: string, sheet: string, members: string[] | null) =>
    data(client.POST("/api/v1/classes/{class_id}/sheet", { ...at({ class_id }), body: { sheet, members } })),
  report: (id: string) => `./api/v1/sheets/${encodeURIComponent(id)}/report`,
  grades: (class_id: string, format: "csv" | "json") => `./api/v1/classes/${class_id}/grades?format=${format}`,
};
