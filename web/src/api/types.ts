import type { components, operations } from "./schema";

/** The server's own types, under the names the page uses. */
type Schemas = components["schemas"];

export type Account = Schemas["Account"];
export type ActiveFault = Schemas["ActiveFault"];
export type AliasReport = Schemas["AliasReport"];
export type AliasSource = Schemas["AliasSource"];
export type AuditEntry = Schemas["AuditEntry"];
export type ApiErrorBody = Schemas["ErrorBody"];
export type DrivingTurn = Schemas["DrivingTurn"]["do"];
export type Benchmark = Schemas["BenchmarkDetail"];
export type BenchmarkRow = Benchmark["results"][number]["rows"][number];
export type Bode = Schemas["Bode"];
export type Bench = Schemas["Bench"];
export type BlockCard = Schemas["BlockCard"];
/** A unit of one's own that can be used. */
export type CheckedUnit = Schemas["CheckedUnit"];
export type BodeOf = Schemas["BodeOf"];
export type Design = Schemas["Design"];
/** A class. */
export type Class = Schemas["Class"];
export type Company = Schemas["Company"];
/** A claim of a live bench, beside what was measured. */
export type Claim = Schemas["BenchClaim"];
export type ClaimList = Schemas["ClaimList"];
export type CompareWith = Schemas["CompareWith"];
export type Comparison = Schemas["Comparison"];
export type Device = Schemas["DeviceCard"];
export type DeviceCatalogue = Schemas["Devices"];
export type Equation = Schemas["EquationCard"];
export type Evaluation = Schemas["Evaluation"];
export type CampaignPicture = Schemas["CampaignPicture"];
export type Distribution = Schemas["Distribution"];
export type DiagnosisTally = Schemas["DiagnosisTally"];
export type ForkFrom = Partial<Schemas["ForkFrom"]>;
export type FaultProfile = Schemas["Profile"];
export type Gallery = Schemas["Gallery"];
export type GalleryCard = Schemas["GalleryCard"];
export type GameCard = Schemas["GameCard"];
export type GameKind = Schemas["Kind"];
/** A line of the table of a game. */
export type GameLine = Schemas["Standing"];
/** A game at a seed, as the caller may see it. */
export type GamePlay = Schemas["Play"];
/** What is handed in at a game, by the names of its parameters. */
export type HandedIn = Record<string, number | string>;
export type ExcitationSource = Schemas["ExcitationSource"];
export type ExcitationReport = Schemas["ExcitationReport"];
/** A hidden fault, and what somebody said of it. */
export type HiddenAnswer = Schemas["Answer"];
export type Identification = Schemas["Identification"];
export type InstabilityMap = Schemas["InstabilityMap"];
/** A number that may be turned to see where a claim begins to hold. */
export type ClaimKnob = Schemas["Knob"];
export type Link = Schemas["Link"];
export type LinkWords = Schemas["Words"];
export type LogEntry = Omit<Schemas["Event"], "command"> & { command?: Command | null };
export type MapSource = Schemas["MapSource"];
export type Me = Schemas["Me"];
export type MeasuredPlant = Schemas["MeasuredPlant"];
export type ModelAccount = Schemas["ModelAccount"];
export type NewBench = Schemas["NewBench"];
export type NewClass = Schemas["NewClass"];
export type NewLink = Schemas["NewLink"];
export type NewRun = Schemas["NewRun"];
export type NewThreshold = Partial<Schemas["NewThreshold"]> &
  Pick<Schemas["NewThreshold"], "metric" | "path" | "low" | "high">;
export type ThresholdRun = Schemas["ThresholdRun"];
export type Threshold = Schemas["Threshold"];
export type Outcomes = Schemas["Outcomes"];
export type Parameter = Schemas["ParameterCard"];
export type ParameterSet = Schemas["ParameterSet"];
/** Which points of a campaign are wanted, and in which order. */
export type PointQuery = NonNullable<operations["get_sweep_points"]["parameters"]["query"]>;
export type PointTally = Schemas["PointTally"];
export type PositiveReal = Schemas["PositiveRealReport"];
export type ProcessSpread = Schemas["ProcessSpread"];
export type LectureCard = Schemas["LectureCard"];
export type Lecture = Schemas["LectureDetail"];
export type Cue = Schemas["CueDetail"];
export type Sentence = Schemas["Sentence"];
export type Vote = Schemas["Vote"];
export type NewVote = Schemas["NewVote"];
export type OpenVote = Schemas["OpenVote"];
export type RateReadout = Schemas["RateReadout"];
/** What is told of a hidden fault. */
export type Question = Schemas["HiddenQuestion"];
export type Recording = Schemas["Recording"];
export type Run = Schemas["Run"];
export type ScenarioSummary = Schemas["ScenarioCard"];
export type RunComparison = Schemas["RunComparison"];
export type Score = Schemas["Scores"];
export type SheetBrief = Schemas["SheetBrief"];
export type SheetCard = Schemas["SheetCard"];
export type SheetSection = Schemas["SectionView"];
export type SheetStep = Schemas["StepView"];
export type SheetView = Schemas["SheetView"];
export type Signal = Schemas["Signal"];
export type SweepPoints = Schemas["SweepPoints"];
export type SweepRun = Schemas["SweepRun"];
export type SweptSine = Schemas["SweptSine"];
export type Wanted = Schemas["Wanted"];
export type Tile = Schemas["Tile"];
export type Verdict = Schemas["Verdict"];
export type Trace = Schemas["Trace"];
export type Turn = Schemas["Turn"];
export type UnitEntry = Schemas["UnitEntry"];
export type UnitMistake = Schemas["UnitMistake"];
export type UnstableRegion = Schemas["UnstableRegionMap"];

/** Which runs and campaigns a list has. */
export type RunFilter = NonNullable<operations["list_runs"]["parameters"]["query"]>;

/** A scenario document as plain values. */
export type Document = Bench["parameters"];

export type Command =
  | Schemas["Start"]
  | Schemas["Pause"]
  | Schemas["Step"]
  | Schemas["StepPeriod"]
  | Schemas["Reset"]
  | Schemas["Undo"]
  | Schemas["Redo"]
  | Schemas["TimeScale"]
  | Schemas["FastForward"]
  | Schemas["Inject"]
  | Schemas["Heal"]
  | Schemas["Set"]
  | Schemas["Switch"]
  | Schemas["MakeSafe"]
  | Schemas["ResetTrip"]
  | Schemas["Seek"]
  | Schemas["Loop"];
/** What is printed of a figure, as it is drawn over a signal. */
export type PrintedMark = Schemas["Mark"];
