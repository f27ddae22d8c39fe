import type { FileBench } from "../in-a-file/file-bench";
import type { FileCommand } from "../in-a-file/file-document";

/** A change of a bench and the commands that take it back. */
interface Change {
  seq: number;
  text: string;
  command: FileCommand;
  back: FileCommand[];
}

type Before = Pick<FileBench, "driving" | "values"> & {
  faults: ReadonlyMap<string, { severity: number; variant: number }>;
};

/** The parts of a bench that commands change, as they are before a command. */
export const stateOf = ({ faults, driving, values }: FileBench): Before => ({
  faults: new Map(faults),
  driving: { ...driving },
  values: { ...values },
});

/** The commands that take a command back, if it can be taken back. */
export function inverseOf(command: FileCommand, { faults, driving, values }: Before, slot: string): FileCommand[] {
  const inject = (name: string): FileCommand[] => {
    const found = faults.get(name);
    return found ? [{ fault: name, severity: found.severity, variant: found.variant }] : [];
  };
  if ("fault" in command) return faults.has(command.fault) ? inject(command.fault) : [{ heal: [command.fault] }];
  if ("heal" in command) return (command.heal === "all" ? [...faults.keys()] : command.heal).flatMap(inject);
  if ("switch" in command) return driving[slot] === command.switch ? [] : [{ switch: driving[slot] }];
  if ("set" in command) {
    const before = Object.keys(command.set).map((path) => [path, values[path]]);
    return [{ set: Object.fromEntries(before) }];
  }
  return [];
}

/** The changes of a bench that can be taken back, and the changes that can be made again. */
export class Changes {
  private done: Change[] = [];
  private undone: Change[] = [];

  get last() {
    return shown(this.done.at(-1));
  }

  get next() {
    return shown(this.undone.at(-1));
  }

  add(change: Change): void {
    this.undone = [];
    if (change.back.length > 0) this.done.push(change);
  }

  forget(): void {
    this.done = [];
    this.undone = [];
  }

  /** Take the last change back, or make it again; its words. */
  move(kind: "undo" | "redo", act: (command: FileCommand) => void): string {
    const [from, to] = kind === "undo" ? [this.done, this.undone] : [this.undone, this.done];
    const change = from.pop();
    if (!change) throw new Error(`there is nothing to ${kind}`);
    for (const command of kind === "undo" ? change.back : [change.command]) act(command);
    to.push(change);
    return `${kind === "undo" ? "undone" : "redone"}: ${change.text}`;
  }
}

const shown = (change: Change | undefined) => (change ? { seq: change.seq, text: change.text } : null);
