import { ApiError, at, client, data, every, rows } from "./client";
import type {
  AliasSource,
  BodeOf,
  Campaign,
  Command,
  CompareWith,
  Design,
  ExcitationSource,
  ForkFrom,
  HealthyStretch,
  LinkWords,
  MapSource,
  NewBenchHere,
  NewLink,
  NewMeasuredDevice,
  NewRun,
  NewThreshold,
  PointQuery,
  RecordReading,
  RunFilter,
  SweptSine,
  Trace,
  Wanted,
} from "./types";

const bench = (bench_id: string) => at({ bench_id });
const run = (run_id: string) => at({ run_id });
const recording = (recording_id: string) => at({ recording_id });
const parameterSet = (set_id: string) => at({ set_id });
const link = (link_id: string) => at({ link_id });
const threshold = (threshold_id: string) => at({ threshold_id });
const sweep = (sweep_id: string) => at({ sweep_id });
/** A file as the body of a request. */
const content = (file: File) => ({
  body: "",
  bodySerializer: () => file,
  headers: { "Content-Type": "application/octet-stream" },
});
const command = (id: string, body: Command) =>
  data(client.POST("/api/v1/benches/{bench_id}/commands", { ...bench(id), body }));

/** The REST calls of the page. */
export const api = {
  catalog: async () => (await data(client.GET("/api/v1/catalog"))).blocks,
  deviceCatalogue: () => data(client.GET("/api/v1/devices")),
  evaluate: (body: Design) => data(client.POST("/api/v1/devices/evaluate", { body })),
  bode: (body: BodeOf) => data(client.POST("/api/v1/devices/bode", { body })),
  spread: (body: Design & { seed: number }) => data(client.POST("/api/v1/devices/spread", { body })),
  identify: (id: string, body: SweptSine) =>
    data(client.POST("/api/v1/benches/{bench_id}/identification", { ...bench(id), body })),
  unstableRegion: (bench_id: string, drive_v: number) =>
    data(client.GET("/api/v1/benches/{bench_id}/unstable-region", at({ bench_id }, { drive_v }))),
  explanation: (bench_id: string, name: string, tick: number) =>
    data(client.GET("/api/v1/benches/{bench_id}/diagnosers/{name}/explain", at({ bench_id, name }, { tick }))),
  turn: (bench_id: string, name: string, tick: number) =>
    data(client.GET("/api/v1/benches/{bench_id}/diagnosers/{name}/turn", at({ bench_id, name }, { tick }))),
  aliases: (bench_id: string, name: string, body: Partial<AliasSource>) =>
    data(
      client.POST("/api/v1/benches/{bench_id}/diagnosers/{name}/aliases", {
        ...at({ bench_id, name }),
        body: { within_um: 0, ...body },
      }),
    ),
  positiveReal: (numerator: number[], denominator: number[]) =>
    data(client.POST("/api/v1/theory/positive-real", { body: { numerator, denominator } })),
  persistency: (body: ExcitationSource) => data(client.POST("/api/v1/theory/persistency", { body })),
  qrCode: (text: string) => data(client.POST("/api/v1/qr", { body: { text } })),
  instabilityMap: (body: MapSource) => data(client.POST("/api/v1/theory/instability-map", { body })),
  readout: (bench_id: string, name: string) =>
    data(client.GET("/api/v1/benches/{bench_id}/readouts/{name}", at({ bench_id, name }))),
  printed: async (id: string) => (await data(client.GET("/api/v1/benches/{bench_id}/printed", bench(id)))).marks,
  claims: (id: string) => data(client.GET("/api/v1/benches/{bench_id}/claims", bench(id))),
  findThreshold: (body: NewThreshold) => data(client.POST("/api/v1/thresholds", { body })),
  threshold: (id: string) => data(client.GET("/api/v1/thresholds/{threshold_id}", threshold(id))),
  cancelThreshold: (id: string) => data(client.DELETE("/api/v1/thresholds/{threshold_id}", threshold(id))),
  plants: (id: string) => data(client.GET("/api/v1/benches/{bench_id}/plants", bench(id))),
  devices: async () => (await data(client.GET("/api/v1/devices"))).devices,
  scenarios: async () => (await data(client.GET("/api/v1/scenarios"))).scenarios,
  /** `first`: the cards in sight, whose figures are made before the others. */
  gallery: (first: string[]) => data(client.GET("/api/v1/gallery", { params: { query: { first } } })),
  benchmark: (benchmark_id: string) => data(client.GET("/api/v1/benchmarks/{benchmark_id}", at({ benchmark_id }))),
  runs: (filter: RunFilter) =>
    every("runs", (page) => client.GET("/api/v1/runs", { params: { query: { ...filter, ...page } } })),
  newestRuns: (filter: RunFilter, most: number) =>
    rows("runs", (page) => client.GET("/api/v1/runs", { params: { query: { ...filter, ...page } } }), most),
  renameRun: (id: string, label: string) =>
    data(client.PATCH("/api/v1/runs/{run_id}", { ...run(id), body: { label } })),
  removeRuns: (ids?: string[]) => data(client.POST("/api/v1/runs/remove", { body: { ids } })),
  compareRuns: (ids: string[]) => data(client.GET("/api/v1/runs/compare", { params: { query: { ids } } })),
  compareTraces: (ids: string[], signal: string) =>
    data(client.GET("/api/v1/runs/compare/trace", { params: { query: { ids, signal } } })),
  run: (id: string) => data(client.GET("/api/v1/runs/{run_id}", run(id))),
  runScenario: async (id: string) =>
    (await data(client.GET("/api/v1/runs/{run_id}/scenario", { ...run(id), parseAs: "text" }))) as string,
  startRun: (body: NewRun) => data(client.POST("/api/v1/runs", { body })),
  cancelRun: (id: string) => data(client.DELETE("/api/v1/runs/{run_id}", run(id))),
  sweep: (id: string) => data(client.GET("/api/v1/sweeps/{sweep_id}", sweep(id))),
  newestSweeps: (filter: RunFilter, most: number) =>
    rows("sweeps", (page) => client.GET("/api/v1/sweeps", { params: { query: { ...filter, ...page } } }), most),
  startSweep: (sweep: Campaign, label: string) => data(client.POST("/api/v1/sweeps", { body: { sweep, label } })),
  renameSweep: (id: string, label: string) =>
    data(client.PATCH("/api/v1/sweeps/{sweep_id}", { ...sweep(id), body: { label } })),
  removeSweeps: (ids?: string[]) => data(client.POST("/api/v1/sweeps/remove", { body: { ids } })),
  cancelSweep: (id: string) => data(client.DELETE("/api/v1/sweeps/{sweep_id}", sweep(id))),
  sweepPoints: (id: string, query: PointQuery) =>
    data(client.GET("/api/v1/sweeps/{sweep_id}/points", at({ sweep_id: id }, query))),
  sweepPicture: (id: string, query: { figure?: string; across?: string }) =>
    data(client.GET("/api/v1/sweeps/{sweep_id}/picture", at({ sweep_id: id }, query))),
  sweepDistribution: (id: string, query: { x: string; y?: string }) =>
    data(client.GET("/api/v1/sweeps/{sweep_id}/distribution", at({ sweep_id: id }, query))),
  scenario: (scenario_id: string) => data(client.GET("/api/v1/scenarios/{scenario_id}", at({ scenario_id }))),
  trace: (bench_id: string, signals: string[], start_tick: number, end_tick: number, columns: number) =>
    data(
      client.GET("/api/v1/benches/{bench_id}/trace", at({ bench_id }, { signals, start_tick, end_tick, columns })),
    ) as Promise<Trace>,
  recordings: () => every("recordings", (query) => client.GET("/api/v1/recordings", { params: { query } })),
  recording: (id: string) => data(client.GET("/api/v1/recordings/{recording_id}", recording(id))),
  record: (id: string, body: Wanted) =>
    data(client.POST("/api/v1/benches/{bench_id}/recordings", { ...bench(id), body })),
  stopRecording: (bench_id: string, recording_id: string) =>
    data(client.POST("/api/v1/benches/{bench_id}/recordings/{recording_id}/stop", at({ bench_id, recording_id }))),
  removeRecording: (id: string) => data(client.DELETE("/api/v1/recordings/{recording_id}", recording(id))),
  replay: (id: string) =>
    data(
      client.POST("/api/v1/recordings/{recording_id}/replay", { ...recording(id), body: { speed: 1, paused: false } }),
    ),
  compare: (id: string, body: CompareWith) =>
    data(client.POST("/api/v1/recordings/{recording_id}/compare", { ...recording(id), body })),
  /** The files of records come and go as they are. */
  bringRecord: (file: File, query: RecordReading) =>
    data(client.POST("/api/v1/records", { params: { query: { ...query, name: file.name } }, ...content(file) })),
  recordColumns: (file: File) =>
    data(client.POST("/api/v1/records/columns", { params: { query: { name: file.name } }, ...content(file) })),
  deviceRecords: () => every("records", (query) => client.GET("/api/v1/records", { params: { query } })),
  deviceRecord: (record_id: string, query: { start?: number; end?: number; points?: number } = {}) =>
    data(client.GET("/api/v1/records/{record_id}", at({ record_id }, query))),
  removeDeviceRecord: (record_id: string) => data(client.DELETE("/api/v1/records/{record_id}", at({ record_id }))),
  calibrateRecord: (record_id: string, body: HealthyStretch) =>
    data(client.POST("/api/v1/records/{record_id}/calibration", { ...at({ record_id }), body })),
  diagnoseRecord: (record_id: string, body: HealthyStretch) =>
    data(client.POST("/api/v1/records/{record_id}/diagnosis", { ...at({ record_id }), body })),
  saveMeasuredDevice: (body: NewMeasuredDevice) => data(client.POST("/api/v1/measured-devices", { body })),
  measuredDevices: () => every("devices", (query) => client.GET("/api/v1/measured-devices", { params: { query } })),
  benches: () => every("benches", (query) => client.GET("/api/v1/benches", { params: { query } })),
  bench: (id: string) => data(client.GET("/api/v1/benches/{bench_id}", bench(id))),
  createBench: (body: NewBenchHere) => data(client.POST("/api/v1/benches", { body })),
  /** Do something to a bench that is not on the page. */
  command,
  /** Let a bench that has just been made run as fast as it goes. */
  runFast: (id: string) => command(id, { kind: "time_scale", value: null }),
  start: (id: string) => command(id, { kind: "start" }),
  reset: (id: string, values: Record<string, unknown>) => command(id, { kind: "reset", values }),
  events: (id: string) => data(client.GET("/api/v1/benches/{bench_id}/events", bench(id))),
  nameBench: (id: string, name: string) =>
    data(client.PATCH("/api/v1/benches/{bench_id}", { ...bench(id), body: { name } })),
  seek: (id: string, tick: number) => command(id, { kind: "seek", tick }),
  reopenBench: (id: string) => data(client.POST("/api/v1/benches/{bench_id}/reopen", bench(id))),
  links: (kind: "experiment" | "layout") =>
    every("links", (page) => client.GET("/api/v1/links", { params: { query: { kind, ...page } } })),
  link: (id: string) => data(client.GET("/api/v1/links/{link_id}", link(id))),
  makeLink: (body: NewLink) => data(client.POST("/api/v1/links", { body })),
  changeLink: (id: string, body: LinkWords) => data(client.PATCH("/api/v1/links/{link_id}", { ...link(id), body })),
  removeLink: (id: string) => data(client.DELETE("/api/v1/links/{link_id}", link(id))),
  openLink: (id: string) => data(client.POST("/api/v1/links/{link_id}/open", link(id))),
  removeBench: (id: string) => data(client.DELETE("/api/v1/benches/{bench_id}", bench(id))),
  fork: (id: string, body: ForkFrom = {}) =>
    data(client.POST("/api/v1/benches/{bench_id}/fork", { ...bench(id), body })),
  /** A second bench from tick 0 with other values; with `repeat` at the tick of the first, all done again. */
  variant: (id: string, set: Record<string, unknown>, repeat = false) =>
    data(client.POST("/api/v1/benches/{bench_id}/variant", { ...bench(id), body: { set, repeat } })),
  snapshots: (bench_id: string) =>
    every("snapshots", (query) => client.GET("/api/v1/benches/{bench_id}/snapshots", at({ bench_id }, query))),
  parameterSets: () => every("sets", (query) => client.GET("/api/v1/parameter-sets", { params: { query } })),
  saveParameterSet: (id: string, name: string) =>
    data(client.POST("/api/v1/benches/{bench_id}/parameter-sets", { ...bench(id), body: { name } })),
  applyParameterSet: (bench_id: string, set_id: string) =>
    data(client.POST("/api/v1/benches/{bench_id}/parameter-sets/{set_id}", at({ bench_id, set_id }))),
  compareParameterSets: (id: string, query: { other?: string; bench?: string }) =>
    data(client.GET("/api/v1/parameter-sets/{set_id}/difference", at({ set_id: id }, query))),
  renameParameterSet: (id: string, name: string) =>
    data(client.PATCH("/api/v1/parameter-sets/{set_id}", { ...parameterSet(id), body: { name } })),
  removeParameterSet: (id: string) => data(client.DELETE("/api/v1/parameter-sets/{set_id}", parameterSet(id))),
  keep: (id: string) => data(client.POST("/api/v1/benches/{bench_id}/snapshots", { ...bench(id), body: {} })),
  /** The bench as it is set now, as a file that runs without a server. */
  benchFile: (id: string): Promise<string> =>
    data(client.GET("/api/v1/benches/{bench_id}/file.html", { ...bench(id), parseAs: "text" })) as Promise<string>,
  scenarioToml: (id: string): Promise<string> =>
    data(client.GET("/api/v1/benches/{bench_id}/scenario", { ...bench(id), parseAs: "text" })) as Promise<string>,
};

/** Why a stream would not open: the close code that fits, or undefined when the server does not answer. */
export async function benchExists(id: string): Promise<number | undefined> {
  try {
    await api.bench(id);
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    if (error.status === 401) return 4401;
    if (error.status === 403) return 4003;
    if (error.status === 404) return 4404;
  }
  return undefined;
}
