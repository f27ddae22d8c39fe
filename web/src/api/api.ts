import { request } from "./request";
import type { Bench, BlockCard, Device, Document, ScenarioSummary } from "./types";

interface NewBench {
  scenario: string | Document;
  set?: Record<string, unknown>;
  seed?: number;
  paused?: boolean;
  time_scale?: number | null;
}

const json = async <T>(response: Promise<Response>): Promise<T> => (await response).json() as Promise<T>;
const bench = (id: string) => `/benches/${encodeURIComponent(id)}`;

/** The REST calls of the page. */
export const api = {
  catalog: async () => (await json<{ blocks: BlockCard[] }>(request("/catalog"))).blocks,
  devices: async () => (await json<{ devices: Device[] }>(request("/devices"))).devices,
  scenarios: async () => (await json<{ scenarios: ScenarioSummary[] }>(request("/scenarios"))).scenarios,
  benches: async () => (await json<{ benches: Bench[] }>(request("/benches"))).benches,
  createBench: (body: NewBench) => json<Bench>(request("/benches", { method: "POST", json: body })),
  removeBench: async (id: string) => void (await request(bench(id), { method: "DELETE" })),
  fork: (id: string, snapshot: string | null = null) =>
    json<Bench>(request(`${bench(id)}/fork`, { method: "POST", json: { snapshot } })),
  scenarioToml: async (id: string) => (await request(`${bench(id)}/scenario`)).text(),
};
