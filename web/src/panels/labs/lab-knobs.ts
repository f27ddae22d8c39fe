import type { Bench, BlockCard } from "../../api/types";
import { section, textOf } from "../card/instances";

/** A number that can be wrong on purpose, turned while the bench runs. */
export interface LabKnob {
  path: string;
  label: string;
  unit: string;
  value: number;
  low: number;
  high: number;
  minimum: number | null;
  maximum: number | null;
  log: boolean;
}

export interface Lab {
  name: string;
  advice: string;
  knobs: LabKnob[];
}

/** Parameters of the labs, with the range of each slider. */
const RANGES: Record<string, { label: string; low: number; high: number; log: boolean }> = {
  assumed_noise_scale: { label: "Assumed variance over true", low: 0.05, high: 20, log: true },
  process_noise_v: { label: "Assumed noise on the voltage", low: 0.003, high: 3, log: true },
  probability_floor: { label: "Floor of the probabilities", low: 0, high: 0.05, log: false },
  switching: { label: "Assumed switching probability", low: 1e-6, high: 0.1, log: true },
  forgetting: { label: "Forgetting factor λ", low: 0.5, high: 1, log: false },
  gate: { label: "Gate of the adaptive factor", low: 1, high: 50, log: true },
  noise_um: { label: "True noise of the sensor", low: 0.001, high: 1, log: true },
  drive_noise_v: { label: "True noise on the drive", low: 0, high: 1, log: false },
  amplitude_v: { label: "Amplitude of the drive", low: 0.1, high: 30, log: true },
  frequency_hz: { label: "Frequency of the drive", low: 50, high: 20_000, log: true },
};

const TRUE_ONES = ["sensor.noise_um", "plant.drive_noise_v", "reference.amplitude_v", "reference.frequency_hz"];

type Blocks = (family: string, name: string) => BlockCard | undefined;

/** Noise lab and lambda lab of one diagnoser: true values, assumed values, and memory. */
export function labsOf(bench: Pick<Bench, "parameters">, id: string, block: Blocks): Lab[] {
  const { parameters } = bench;
  const sensor = textOf(parameters, "sensor", "kind", "ideal");
  const where: Record<string, { family: string; name: string; tables: string[] }> = {
    sensor: { family: "sense", name: sensor, tables: [`sensors.${sensor}`, "sensor"] },
    plant: { family: "plant", name: textOf(parameters, "plant", "model", "linear"), tables: ["plant"] },
    reference: { family: "reference", name: textOf(parameters, "reference", "kind", "sine"), tables: ["reference"] },
    [`diagnosers.${id}`]: {
      family: "diagnose",
      name: textOf(parameters, `diagnosers.${id}`, "kind", "mmae"),
      tables: [`diagnosers.${id}`],
    },
  };
  const knob = (path: string): LabKnob[] => {
    const cut = path.lastIndexOf(".");
    const [table, name] = [path.slice(0, cut), path.slice(cut + 1)];
    const range = RANGES[name];
    const place = where[table];
    const parameter = place && block(place.family, place.name)?.parameters.find((p) => p.name === name);
    if (!range || !parameter?.live) return [];
    const stated = place.tables.map((t) => section(parameters, t)[name]).find((v) => typeof v === "number");
    const value = stated ?? parameter.default;
    if (typeof value !== "number") return [];
    const { unit, minimum, maximum } = parameter;
    return [{ path, ...range, unit, value, minimum, maximum }];
  };
  const own = (...names: string[]) => names.flatMap((name) => knob(`diagnosers.${id}.${name}`));
  const labs = [
    { name: "True values", advice: "The bench itself.", knobs: TRUE_ONES.flatMap(knob) },
    {
      name: "Assumed values",
      advice: "With too little assumed noise the diagnoser is too sure; with too much it cannot decide.",
      knobs: own("assumed_noise_scale", "process_noise_v", "probability_floor", "switching"),
    },
    {
      name: "Memory",
      advice:
        "A factor near 1 averages for long and notices late; a small one notices early and switches falsely more often.",
      knobs: own("forgetting", "gate"),
    },
  ];
  return labs.filter((lab) => lab.knobs.length > 0);
}

/** How long a forgetting factor remembers, in samples. */
export const memorySamples = (forgetting: number): number => 1 / (1 - forgetting);
