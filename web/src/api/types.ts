import type { components, operations } from "./schema";

export type * from "./schema";

/** The server's own types, where the page has another name for them. */
type Schemas = components["schemas"];

export type ApiErrorBody = Schemas["ErrorBody"];
export type DrivingTurn = Schemas["DrivingTurn"]["do"];
export type Benchmark = Schemas["BenchmarkDetail"];
export type BenchmarkRow = Benchmark["results"][number]["rows"][number];
/** A claim of a live bench with the measured figure. */
export type Claim = Schemas["BenchClaim"];
export type Device = Schemas["DeviceCard"];
export type DeviceCatalogue = Schemas["DeviceList"];
export type Equation = Schemas["EquationCard"];
export type ForkFrom = Partial<Schemas["ForkFrom"]>;
export type FaultProfile = Schemas["Profile"];
export type GameKind = Schemas["Kind"];
/** A line of the table of a game. */
export type GameLine = Schemas["Standing"];
/** A game at a seed, as the caller may see it. */
export type GamePlay = Schemas["Play"];
/** The values handed in at a game, by the names of its parameters. */
export type HandedIn = Record<string, number | string>;
/** A hidden fault and the answer to it. */
export type HiddenAnswer = Schemas["Answer"];
/** A number that may be turned to see where a claim begins to hold. */
export type ClaimKnob = Schemas["Knob"];
export type ChangedValue = Schemas["ChangedValue"];
export type LinkWords = Schemas["Words"];
export type LogEntry = Omit<Schemas["Event"], "command"> & { command?: Command | null };
export type NewThreshold = Partial<Schemas["NewThreshold"]> &
  Pick<Schemas["NewThreshold"], "metric" | "path" | "low" | "high">;
/** Of a bench without a server with the values that it can have, where it cannot have all. */
export type Parameter = Schemas["ParameterCard"] & { grid?: number[] | null };
/** Which points of a campaign are wanted, and in which order. */
export type PointQuery = NonNullable<operations["get_sweep_points"]["parameters"]["query"]>;
export type PositiveReal = Schemas["PositiveRealReport"];
export type Lecture = Schemas["LectureDetail"];
export type Cue = Schemas["CueDetail"];
/** The known part of a hidden fault. */
export type Question = Schemas["HiddenQuestion"];
export type ScenarioSummary = Schemas["ScenarioCard"];
export type Score = Schemas["Scores"];
export type SheetSection = Schemas["SectionView"];
export type SheetStep = Schemas["StepView"];
export type UnstableRegion = Schemas["UnstableRegionMap"];

/** How the columns of a file with a record are to be read. */
export type RecordReading = Omit<operations["bring_record"]["parameters"]["query"], "name">;

/** Which runs and campaigns a list has. */
export type RunFilter = NonNullable<operations["list_runs"]["parameters"]["query"]>;

/** A scenario document as plain values. */
export type Document = Schemas["Bench"]["parameters"];

/** A command to a bench. */
export type Command = operations["command"]["requestBody"]["content"]["application/json"];

/** A printed figure as a mark over a signal. */
export type PrintedMark = Schemas["Mark"];
