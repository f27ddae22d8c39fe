import { NativeSelect, type NativeSelectProps } from "@mantine/core";
import { useMemo } from "react";
import { api } from "../api/api";
import { useAsked } from "../api/queries";
import type { ScenarioSummary } from "../api/types";
import { byChapter, chapterName, chapterOf } from "../gallery/chapters";

const NONE: ScenarioSummary[] = [];

/** The scenarios of the library that have a bench, in the order of the book. */
export function useLibrary(): ScenarioSummary[] {
  const { answer = NONE } = useAsked(["scenarios"], api.scenarios);
  return useMemo(() => answer.filter(({ plant }) => plant !== null).sort(byChapter), [answer]);
}

interface ScenarioSelectProps extends Omit<NativeSelectProps, "data" | "onChange"> {
  value: string;
  onChange(id: string): void;
}

/** A scenario of the library, by its title under its chapter. */
export function ScenarioSelect({ value, onChange, ...field }: ScenarioSelectProps) {
  const library = useLibrary();
  const data = useMemo(() => {
    const chapters = [...new Set(library.map(({ id }) => chapterOf(id)))];
    return chapters.map((chapter) => ({
      group: chapterName(chapter),
      items: library
        .filter(({ id }) => chapterOf(id) === chapter)
        .map(({ id, title }) => ({ value: id, label: title })),
    }));
  }, [library]);
  return <NativeSelect {...field} value={value} data={data} onChange={(e) => onChange(e.currentTarget.value)} />;
}
