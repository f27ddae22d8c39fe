import type { components } from "../api/schema";
import type { Bench, BlockCard, Lecture, LogEntry, Recording } from "../api/types";
import type { FileDocument } from "../in-a-file/file-document";
import type { FolderAnswers } from "../in-a-folder/folder-server";
import type { Status } from "../stream/wire";

type Schemas = components["schemas"];

/** A frame of one panel. */
export interface RecordedFrame {
  signals: string[];
  /** In base64. */
  bytes: string;
}

/** A paused bench with an active fault: messages of its stream, and pictures of its scope and of its banks. */
interface RecordedBench {
  hello: { bench: Bench };
  status: Status;
  events: { events: LogEntry[] };
  /** By plot: `scope`, or the name of a diagnoser. */
  frames: Record<string, RecordedFrame>;
}

/** Answers of a service, by name. */
interface RecordedAnswers {
  catalog: { blocks: BlockCard[] };
  scenarios: Schemas["ScenarioList"];
  devices: Schemas["DeviceList"];
  gallery: Schemas["Gallery"];
  run: Schemas["Run"];
  sweep: Schemas["SweepRun"];
  class: Schemas["MemberList"] & { class: Schemas["Class"] };
  sheet: Schemas["SheetView"];
  explanation: Schemas["Account"];
  turn: Schemas["Turn"];
  aliases: Schemas["AliasReport"];
  identification: Schemas["Identification"];
  "unstable-region": Schemas["UnstableRegionMap"];
  "parameter-sets": { sets: Schemas["ParameterSet"][]; difference: Schemas["Difference"] };
  claims: Schemas["ClaimList"];
  design: {
    evaluation: Schemas["Evaluation"];
    bode: Schemas["Bode"];
    spread: Schemas["ProcessSpread"];
    gyroscope: Schemas["Evaluation"];
  };
  theory: {
    positiveReal: Schemas["PositiveRealReport"];
    persistency: Schemas["ExcitationReport"];
    map: Schemas["InstabilityMap"];
  };
  campaign: {
    points: Schemas["SweepPoints"];
    picture: Schemas["CampaignPicture"];
    density: Schemas["Distribution"];
    histogram: Schemas["Distribution"];
    comparison: Schemas["RunComparison"];
    trace: Schemas["RunTraces"];
  };
  /** A bench with a hidden fault, and its exercise before and after an answer. */
  blind: { bench: Bench; asked: Schemas["Blindness"]; answered: Schemas["Blindness"] };
  games: {
    games: Schemas["GameCard"][];
    plays: Record<string, { before: Schemas["Play"]; after: Schemas["Play"] }>;
  };
  sheets: Schemas["SheetList"];
  votes: { open: Schemas["Vote"]; revealed: Schemas["Vote"] };
  lectures: { lectures: Schemas["LectureCard"][]; lecture: Lecture };
  recordings: { recordings: Recording[]; compared: Schemas["Comparison"] };
  units: {
    units: Schemas["UnitList"];
    source: string;
    checked: Schemas["UnitCheck"];
    mistake: Schemas["UnitCheck"];
  };
  benchmark: Schemas["BenchmarkDetail"];
}

const files = import.meta.glob<string>("./recorded/*.json", { query: "?raw", import: "default" });

const read = async (name: string) => JSON.parse(await files[`./recorded/${name}.json`]());

/** A bench of `scripts/record_answers.py`; each call gives a copy of its own. */
export async function recordedBench(name: "first-look" | "seven-steps" | "gyroscope") {
  const { hello, status, events, frames } = (await read(name)) as RecordedBench;
  return { bench: hello.bench, status, events: events.events, frames };
}

/** An answer of `scripts/record_answers.py`; each call gives a copy of its own. */
export const recordedAnswer = <Name extends keyof RecordedAnswers>(name: Name): Promise<RecordedAnswers[Name]> =>
  read(name);

const KINDS = {
  float64: (numbers: (number | string)[]) => Float64Array.from(numbers, Number),
  float32: (numbers: (number | string)[]) => Float32Array.from(numbers, Number),
  int64: (numbers: (number | string)[]) => BigInt64Array.from(numbers, BigInt),
  uint64: (numbers: (number | string)[]) => BigUint64Array.from(numbers, BigInt),
};

/** The first look as a bench in a folder. */
export async function recordedFolder() {
  const { code, document, answers } = await read("folder");
  const arrays = (_: string, value: { array?: keyof typeof KINDS; numbers: number[] } | null) =>
    value?.array ? KINDS[value.array](value.numbers) : value;
  return {
    code: Uint8Array.from(atob(code), (letter) => letter.charCodeAt(0)),
    document: JSON.parse(JSON.stringify(document), arrays) as FileDocument,
    answers: { ...answers, catalog: (await read("catalog")).blocks } as FolderAnswers,
  };
}
