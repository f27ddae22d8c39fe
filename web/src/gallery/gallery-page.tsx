import { Button, Group, Progress } from "@mantine/core";
import { IconFolderOpen } from "@tabler/icons-react";
import { useCallback, useMemo, useRef, useState } from "react";
import { api } from "../api/api";
import { useMay } from "../api/me";
import { useAnswer } from "../api/queries";
import { PageHead } from "../bench/page-head";
import { setPage, useView } from "../bench/view-store";
import { isActive } from "../runs/jobs";
import { EmptyState } from "../ui/empty-state";
import { formatCount, formatNumber } from "../ui/format";
import { Stale } from "../ui/stale";
import { chosen, EVERYTHING } from "./chapters";
import { Filters } from "./filters";
import styles from "./gallery.module.css";
import { GalleryEntry } from "./gallery-entry";
import { LectureList } from "./lecture-list";

const BUSY_MS = 700;
const CALM_MS = 15_000;
/** Most cards that are named as in sight, in the order in which they came. */
const MOST_FIRST = 64;

/** Every experiment of the library: its claim, the measured values, and whether they agree. */
export function GalleryPage() {
  const inSight = useRef(new Set<string>());
  const { value, error, since, again } = useAnswer(
    ["gallery"],
    () => api.gallery([...inSight.current].slice(0, MOST_FIRST)),
    (now) => (now?.figures.is_making || now?.cards.some((card) => isActive(card.state)) ? BUSY_MS : CALM_MS),
  );
  const onSight = useCallback((id: string, isShown: boolean) => {
    inSight.current[isShown ? "add" : "delete"](id);
  }, []);
  const item = useView((s) => s.item);
  const [filter, setFilter] = useState(EVERYTHING);
  const drives = useMay("drive");
  const teaches = useMay("teach");
  const all = value?.cards;
  const figures = value?.figures;
  const one = all?.find(({ id }) => id === item);
  const cards = useMemo(() => (one ? [one] : item ? [] : chosen(all ?? [], filter)), [all, filter, item, one]);
  const busy = all?.filter((card) => isActive(card.state)).length ?? 0;
  const showAll = () => {
    setFilter(EVERYTHING);
    setPage("gallery");
  };

  return (
    <main className="paper">
      <header className="card page-top">
        <PageHead name="Gallery" item={one?.title} />
        {item ? (
          <Button size="xs" onClick={() => setPage("gallery")}>
            All experiments
          </Button>
        ) : (
          <Filters all={all ?? []} filter={filter} onChange={setFilter} />
        )}
        {all && !item && (
          <output className="note">
            {cards.length === all.length
              ? formatCount(all.length, "experiment")
              : `${formatNumber(cards.length, 0)} of ${formatNumber(all.length, 0)}`}
            {busy > 0 && `, ${formatNumber(busy, 0)} under way`}
          </output>
        )}
        {drives && !item && (
          <Button
            size="xs"
            leftSection={<IconFolderOpen size={16} />}
            onClick={() => useView.setState({ dialog: "mine" })}
          >
            {teaches ? "Mine, or from disk" : "From disk"}
          </Button>
        )}
        {figures?.is_making && (
          <Group className="note" gap={8}>
            Figures: {formatNumber(figures.made, 0)} of {formatNumber(figures.total, 0)}
            <Progress
              value={(100 * figures.made) / figures.total}
              size="sm"
              w={120}
              aria-label="Figures that have been made"
            />
          </Group>
        )}
        {figures?.problem && (
          <p className="wrong" role="status">
            {figures.problem}
          </p>
        )}
        <Stale error={error} since={since} onRetry={again} />
      </header>
      {teaches && !item && <LectureList />}
      {value && cards.length > 0 ? (
        <ul
          className={styles.grid}
          data-one={one !== undefined}
          data-stale={error !== undefined}
          aria-label="Experiments"
        >
          {cards.map((card) => (
            <GalleryEntry
              key={card.id}
              card={card}
              isMaking={figures?.is_making === true}
              onChanged={again}
              onSight={onSight}
            />
          ))}
        </ul>
      ) : value ? (
        <EmptyState
          title={item ? `The library has no experiment ${item}` : "No experiment matches"}
          action={
            <Button size="xs" onClick={showAll}>
              Show all
            </Button>
          }
        >
          {item
            ? "The address may be of another version."
            : "Choose another chapter or verdict, or search for fewer words."}
        </EmptyState>
      ) : (
        !error && <EmptyState title="Opening the gallery">Claims and measurements come from the server.</EmptyState>
      )}
    </main>
  );
}
