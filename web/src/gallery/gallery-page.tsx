import { Button, NativeSelect, TextInput } from "@mantine/core";
import { IconFolderOpen, IconPlayerTrackNext } from "@tabler/icons-react";
import { useMemo, useState } from "react";
import { api } from "../api/api";
import { useAnswer } from "../api/use-answer";
import { showError } from "../bench/send";
import { useView } from "../bench/view-store";
import { EmptyState } from "../ui/empty-state";
import { Stale } from "../ui/stale";
import { chapterName, chaptersOf, chosen, EVERYTHING, VERDICTS } from "./chapters";
import styles from "./gallery.module.css";
import { GalleryEntry } from "./gallery-entry";

const BUSY_MS = 700;
const CALM_MS = 15_000;
/** Between two starts, so that the server's limit on commands is never met. */
const PACE_MS = 60;

const isUnderWay = (state: string) => state === "queued" || state === "running";

/** Every experiment of the library: what is claimed, what was measured, and whether that agrees. */
export function GalleryPage() {
  const { value, error, since, again } = useAnswer(api.gallery, (now) =>
    now?.some((card) => isUnderWay(card.state)) ? BUSY_MS : CALM_MS,
  );
  const [filter, setFilter] = useState(EVERYTHING);
  const cards = useMemo(() => chosen(value ?? [], filter), [value, filter]);
  const missing = cards.filter((card) => card.state !== "done" && !isUnderWay(card.state));
  const busy = value?.filter((card) => isUnderWay(card.state)).length ?? 0;
  const set = (part: Partial<typeof filter>) => setFilter({ ...filter, ...part });

  const runMissing = async () => {
    try {
      for (const { id } of missing) {
        await api.startRun({ scenario: id });
        await new Promise((resolve) => setTimeout(resolve, PACE_MS));
      }
    } catch (refused) {
      showError(refused);
    }
    again();
  };

  return (
    <main className={styles.page}>
      <header className={styles.top}>
        <h1>Gallery</h1>
        <NativeSelect
          size="xs"
          aria-label="Chapter"
          value={filter.chapter}
          data={[
            { value: "all", label: "All chapters" },
            ...chaptersOf(value ?? []).map((name) => ({ value: name, label: chapterName(name) })),
          ]}
          onChange={(e) => set({ chapter: e.currentTarget.value })}
        />
        <NativeSelect
          size="xs"
          aria-label="Verdict"
          value={filter.verdict}
          data={[
            { value: "all", label: "Any verdict" },
            ...VERDICTS.map((verdict) => ({ value: verdict, label: verdict })),
            { value: "open", label: "not run, or other than expected" },
          ]}
          onChange={(e) => set({ verdict: e.currentTarget.value })}
        />
        <TextInput
          size="xs"
          type="search"
          placeholder="Search"
          aria-label="Search the gallery"
          value={filter.words}
          onChange={(e) => set({ words: e.currentTarget.value })}
        />
        {value && (
          <output className={styles.count}>
            {cards.length === value.length ? `${value.length} experiments` : `${cards.length} of ${value.length}`}
            {busy > 0 && `, ${busy} under way`}
          </output>
        )}
        <Button
          size="xs"
          variant="default"
          leftSection={<IconFolderOpen size={16} />}
          onClick={() => useView.setState({ dialog: "mine" })}
        >
          Mine, or from disk
        </Button>
        <Stale error={error} since={since} onRetry={again} />
        {missing.length > 0 && (
          <Button
            size="xs"
            ml="auto"
            leftSection={<IconPlayerTrackNext size={16} />}
            title="Headless, one after the other, at lower priority than the live benches"
            onClick={runMissing}
          >
            Run the {missing.length} not run yet
          </Button>
        )}
      </header>
      {value && cards.length > 0 ? (
        <ul className={styles.grid} data-stale={error !== undefined} aria-label="Experiments">
          {cards.map((card) => (
            <GalleryEntry key={card.id} card={card} onChanged={again} />
          ))}
        </ul>
      ) : value ? (
        <EmptyState
          title="No experiment is like that"
          action={
            <Button size="xs" variant="default" onClick={() => setFilter(EVERYTHING)}>
              Show all
            </Button>
          }
        >
          Take another chapter or verdict, or fewer words.
        </EmptyState>
      ) : (
        !error && <EmptyState title="Opening the gallery">Claims and measurements come from the server.</EmptyState>
      )}
    </main>
  );
}
