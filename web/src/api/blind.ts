import { at, client, data } from "./client";
import type { HiddenAnswer } from "./types";

const ofBench = (bench_id: string) => at({ bench_id });
const ofClass = (class_id: string) => at({ class_id });

/** The REST calls around hidden faults: on a bench, and for a class. */
export const blind = {
  of: (bench: string) => data(client.GET("/api/v1/benches/{bench_id}/blind", ofBench(bench))),
  hide: (bench: string, seed: number) =>
    data(client.POST("/api/v1/benches/{bench_id}/blind", { ...ofBench(bench), body: { seed, shows: false } })),
  answer: (bench: string, said: string, confidence: number) =>
    data(client.POST("/api/v1/benches/{bench_id}/blind/answer", { ...ofBench(bench), body: { said, confidence } })),
  giveUp: (bench: string) => data(client.DELETE("/api/v1/benches/{bench_id}/blind", ofBench(bench))),
  hideForAll: (group: string, scenario: string, shows: boolean, members: string[] | null) =>
    data(client.POST("/api/v1/classes/{class_id}/blind", { ...ofClass(group), body: { scenario, shows, members } })),
  revealAll: (group: string) => data(client.DELETE("/api/v1/classes/{class_id}/blind", ofClass(group))),
};

/** The hypotheses of an answer, as the words for them are found by. */
export const answersOf = ({ factors }: Pick<HiddenAnswer, "factors">) => ({
  answers: { kind: "", names: Object.keys(factors), factors: Object.values(factors) },
});
