import type { Command, LogEntry } from "../api/types";

// A command of the log as scripts write it; `testing/cases/as-code.json` holds the texts that shells, servers and Python read in a test.

/** The bench of a log: where its server is, and the scenario it was made of. */
export interface Source {
  /** Address of the page, up to its last slash. */
  address: string;
  bench: string;
  scenario: string;
  /** Its length in ticks, if it has one. */
  samples: number | null;
}

export const LANGUAGES = { rest: "REST, with curl", cli: "Command line, headless", python: "Python" } as const;

export type Language = keyof typeof LANGUAGES;

/** The samples of a headless run of a scenario without a length. */
const HEADLESS_SAMPLES = 10_000;
const MOMENT = ["at_sample", "at_ms", "when"];

/** The command of an event in each language that can say it; a headless run takes no command that runs a bench. */
export function asCode(event: Pick<LogEntry, "tick" | "command">, source: Source): Partial<Record<Language, string>> {
  const { command, tick } = event;
  if (!command) return {};
  const texts = { rest: asCurl(command, source), python: asPython(command, source) };
  return "kind" in command ? texts : { ...texts, cli: asRun(command, tick, source) };
}

function asCurl(command: Command, { address, bench }: Source): string {
  const headers = '-H "Authorization: Bearer $COMBBENCH_TOKEN" -H "Content-Type: application/json"';
  const url = `${address}api/v1/benches/${bench}/commands`;
  return `curl ${headers} -d ${quoted(JSON.stringify(command))} ${quoted(url)}`;
}

/** A run with this event alone, long enough to show its effect. */
function asRun(command: Command, tick: number, { scenario, samples: own }: Source): string {
  const samples = own ?? HEADLESS_SAMPLES;
  const event = MOMENT.some((name) => name in command) ? command : { at_sample: tick, ...command };
  const length = tick < samples ? "" : ` --set samples=${tick + samples}`;
  return `combbench run ${quoted(scenario)}${length} --set ${quoted(`events=[${literal(event, TOML)}]`)}`;
}

function asPython(command: Command, { address, bench }: Source): string {
  const fields = Object.entries(command).map(([name, value]) => `${name}=${literal(value, PYTHON)}`);
  return [
    "from combbench_client import Bench, Client  # clients/combbench_client.py; the token is read from COMBBENCH_TOKEN",
    "",
    `lab = Client(${JSON.stringify(address)})`,
    `Bench(lab, ${JSON.stringify(bench)}).command(${fields.join(", ")})`,
  ].join("\n");
}

/** A word of a shell. */
const quoted = (text: string): string => (/^[\w./:-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

/** How a language writes what JSON writes otherwise. */
interface Words {
  between: string;
  name(name: string): string;
  nothing?: string;
  truth(value: boolean): string;
}

const TOML: Words = {
  between: " = ",
  name: (name) => (/^\w+$/.test(name) ? name : JSON.stringify(name)),
  truth: String,
};
const PYTHON: Words = {
  between: ": ",
  name: JSON.stringify,
  nothing: "None",
  truth: (value) => (value ? "True" : "False"),
};

function literal(value: unknown, words: Words): string {
  if (Array.isArray(value)) return `[${value.map((one) => literal(one, words)).join(", ")}]`;
  if (value === null) return words.nothing ?? '""';
  if (typeof value === "boolean") return words.truth(value);
  if (typeof value !== "object") return JSON.stringify(value);
  const fields = Object.entries(value as object).filter(([, one]) => one !== null || words.nothing);
  return `{${fields.map(([name, one]) => words.name(name) + words.between + literal(one, words)).join(", ")}}`;
}
