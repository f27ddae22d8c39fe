import { NativeSelect, TextInput } from "@mantine/core";
import type { GalleryCard } from "../api/types";
import { VERDICTS } from "../ui/verdict";
import { chapterName, chaptersOf, type GalleryFilter } from "./chapters";

interface FiltersProps {
  all: readonly GalleryCard[];
  filter: GalleryFilter;
  onChange(filter: GalleryFilter): void;
}

/** What leaves some of the experiments: a chapter, a verdict, words. */
export function Filters({ all, filter, onChange }: FiltersProps) {
  const set = (part: Partial<GalleryFilter>) => onChange({ ...filter, ...part });
  return (
    <>
      <NativeSelect
        aria-label="Chapter"
        value={filter.chapter}
        data={[
          { value: "all", label: "All chapters" },
          ...chaptersOf(all).map((name) => ({ value: name, label: chapterName(name) })),
        ]}
        onChange={(e) => set({ chapter: e.currentTarget.value })}
      />
      <NativeSelect
        aria-label="Verdict"
        value={filter.verdict}
        data={[
          { value: "all", label: "Any verdict" },
          ...VERDICTS.map((verdict) => ({ value: verdict, label: verdict })),
          { value: "open", label: "not measured, or other than expected" },
        ]}
        onChange={(e) => set({ verdict: e.currentTarget.value })}
      />
      <TextInput
        type="search"
        placeholder="Title, device, controller, fault"
        aria-label="Search the gallery"
        w={240}
        value={filter.words}
        onChange={(e) => set({ words: e.currentTarget.value })}
      />
    </>
  );
}
