import { formatCount, formatSi } from "../ui/format";
import type { BoardDocument, FileEntry, Told } from "./file-document";

export type Finding = Pick<FileEntry, "kind" | "text" | "old" | "new">;

/** Tells the findings of the diagnosers and the warnings of the blocks, from the signals that change with them. */
export class Findings {
  private readonly document: BoardDocument;
  private readonly columns: number[];

  constructor(document: BoardDocument) {
    this.document = document;
    this.columns = [...document.followed.columns].map(Number);
  }

  /** The findings in the signals after a tick; `last` has the numbers of before, and then the numbers of now. */
  look(signals: Float64Array, last: Float64Array): Finding[] {
    const { told } = this.document.followed;
    const changed = this.columns.flatMap((column, k) => {
      const value = signals[column];
      if (value === last[k] || (Number.isNaN(value) && Number.isNaN(last[k]))) return [];
      last[k] = value;
      return [{ told: told[k], value }];
    });
    const of = (kinds: string[]) => changed.filter((one) => kinds.includes(one.told.kind));
    const warnings = of(["warning"]).filter(({ value }) => value > 0);
    const scored = new Set(of(["truth", "delay"]).map((one) => one.told.diagnoser ?? ""));
    return [
      ...warnings.map((one) => ({ kind: "warning", text: one.told.text ?? "", old: null, new: null })),
      ...[...scored].flatMap((name) => this.recognised(name, signals, of(["truth", "delay"]))),
      ...of(["verdict", "region", "alarm", "unexcited"]).map((one) => this.said(one.told, one.value, signals)),
    ];
  }

  private recognised(name: string, signals: Float64Array, changed: { told: Told; value: number }[]): Finding[] {
    const own = changed.filter((one) => one.told.diagnoser === name).sort((a) => (a.told.kind === "truth" ? -1 : 1));
    const truth = signals[this.columnOf("truth", name)];
    const label = truth >= 0 ? this.document.diagnosers[name].names[truth] : "none of the hypotheses";
    return own.flatMap(({ told, value }): Finding[] => {
      if (told.kind === "truth")
        return [{ kind: "truth_changed", text: `${name}: the truth is ${label}`, old: null, new: label }];
      if (value < 0) return [];
      const text = value === 0 ? `${name} said ${label} already` : `${name} found ${label} after ${this.time(value)}`;
      return [{ kind: "recognised", text, old: value, new: label }];
    });
  }

  private time(samples: number): string {
    return `${formatCount(samples, "sample")} (${formatSi(samples * this.document.dt_ms, "ms", 3)})`;
  }

  private said({ kind, diagnoser = "", words = [], left, columns }: Told, value: number, signals: Float64Array) {
    const names = this.document.diagnosers[diagnoser].names.filter((_, i) => signals[columns?.[i] ?? 0] !== 0);
    const text = left?.includes(value) ? `${words[value]}: ${names.join(", ")}` : words[value];
    return { kind, text: `${diagnoser}: ${text}`, old: null, new: text };
  }

  private columnOf(kind: string, diagnoser: string): number {
    return this.columns[
      this.document.followed.told.findIndex((one) => one.kind === kind && one.diagnoser === diagnoser)
    ];
  }
}
