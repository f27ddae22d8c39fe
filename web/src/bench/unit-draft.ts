import { create } from "zustand";
import { createJSONStorage, persist } from "zustand/middleware";
import { storageName } from "../api/storage-name";

/** A text that was on a bench, or was left for another. */
export interface UnitVersion {
  /** When, as a browser counts. */
  at: number;
  source: string;
  /** The first line that differs from the version before, from 1. */
  line: number;
  state: "ran" | "tripped" | "refused" | "left";
}

interface DraftStore {
  name: string;
  source: string;
  /** Run it after a pause in typing. */
  asYouType: boolean;
  /** The text that was tried last, or that was there when the page was opened: it does not run by itself. */
  tried: string;
  versions: Record<string, UnitVersion[]>;
}

const MOST_VERSIONS = 50;
/** Of all names together; a browser keeps some millions. */
const MOST_CHARACTERS = 1_000_000;

/** The unit in the editor, and the versions of each name; this browser keeps them. */
export const useDraft = create<DraftStore>()(
  persist((): DraftStore => ({ name: "", source: "", asYouType: true, tried: "", versions: {} }), {
    name: storageName("combbench.unit"),
    storage: createJSONStorage(() => localStorage),
    merge: (kept, fresh) => {
      const known = { ...fresh, ...(kept as Partial<DraftStore>) };
      return { ...known, tried: known.source };
    },
  }),
);

/** The first line in which two texts differ, from 1. */
export function firstDifference(before: string, now: string): number {
  const [a, b] = [before.split("\n"), now.split("\n")];
  const at = b.findIndex((line, i) => line !== a[i]);
  return (at < 0 ? Math.min(a.length, b.length) : at) + 1;
}

/** The versions with one more, which takes the place of an equal last one; the oldest go when there are too many. */
export function withVersion(versions: UnitVersion[], source: string, state: UnitVersion["state"]): UnitVersion[] {
  const last = versions.at(-1);
  if (last?.source === source) return [...versions.slice(0, -1), { ...last, state }];
  const line = last ? firstDifference(last.source, source) : 1;
  return [...versions, { at: Date.now(), source, line, state }].slice(-MOST_VERSIONS);
}

/** The versions that fit into the room a browser has; of the longest lists the oldest go first. */
export function fitting(all: Record<string, UnitVersion[]>, room = MOST_CHARACTERS): Record<string, UnitVersion[]> {
  const kept = { ...all };
  const size = () => Object.values(kept).reduce((sum, list) => sum + list.reduce((n, v) => n + v.source.length, 0), 0);
  while (size() > room) {
    const [longest] = Object.entries(kept).sort(([, a], [, b]) => b.length - a.length)[0];
    kept[longest] = kept[longest].slice(1);
    if (kept[longest].length === 0) delete kept[longest];
  }
  return kept;
}

/** Note what became of a text. */
export function noteVersion(name: string, source: string, state: UnitVersion["state"]): void {
  useDraft.setState(({ versions }) => ({
    versions: fitting({ ...versions, [name]: withVersion(versions[name] ?? [], source, state) }),
  }));
}

/** The newest version that ran, but for the text of now. */
export const lastThatWorked = (versions: readonly UnitVersion[], source: string): UnitVersion | undefined =>
  versions.findLast((version) => version.state === "ran" && version.source !== source);

/** Put another text into the editor; the one before is kept as a version. */
export function beginWith(name: string, source: string): void {
  const before = useDraft.getState();
  const known = before.versions[before.name]?.some((version) => version.source === before.source);
  if (before.source.trim() && !known) noteVersion(before.name, before.source, "left");
  useDraft.setState({ name, source });
}

/** The default name of a unit: the name of its class. */
export const nameOfClass = (source: string): string =>
  /^class\s+([A-Za-z]\w*)/m
    .exec(source)?.[1]
    .replace(/([a-z0-9])([A-Z])/g, "$1_$2")
    .toLowerCase()
    .slice(0, 32) ?? "";

const NAME = /^[a-z][a-z0-9_]{0,31}$/;

/** Whether the server takes a name. */
export const isUnitName = (name: string): boolean => NAME.test(name);
