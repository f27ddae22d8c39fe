import type { components } from "./schema";

/** The server's own types, under the names the page uses. */
type Schemas = components["schemas"];

export type ActiveFault = Schemas["ActiveFault"];
export type ApiErrorBody = Schemas["ErrorBody"];
export type Bench = Schemas["Bench"];
export type BlockCard = Schemas["BlockCard"];
export type Device = Schemas["DeviceCard"];
export type Equation = Schemas["EquationCard"];
export type FaultProfile = Schemas["Profile"];
export type LogEntry = Schemas["Event"];
export type NewBench = Schemas["NewBench"];
export type Parameter = Schemas["ParameterCard"];
export type ScenarioSummary = Schemas["ScenarioCard"];
export type Score = Schemas["Scores"];
export type Signal = Schemas["Signal"];

/** A scenario document as plain values. */
export type Document = Bench["parameters"];

export type Command =
  | Schemas["Start"]
  | Schemas["Pause"]
  | Schemas["Step"]
  | Schemas["StepPeriod"]
  | Schemas["Reset"]
  | Schemas["TimeScale"]
  | Schemas["Inject"]
  | Schemas["Heal"]
  | Schemas["Set"]
  | Schemas["Switch"]
  | Schemas["ResetTrip"];
