import { Box, Button, Group, Progress } from "@mantine/core";
import { IconFileText, IconPlayerPlay, IconPlayerTrackNext } from "@tabler/icons-react";
import { useEffect, useRef } from "react";
import { api } from "../api/api";
import { useMay } from "../api/me";
import type { GalleryCard } from "../api/types";
import { openOwn } from "../bench/open-bench";
import { PlaceLink } from "../bench/page-head";
import { showError } from "../bench/send";
import { useBusy } from "../bench/use-busy";
import { setPage } from "../bench/view-store";
import { isActive } from "../runs/jobs";
import { useOnScreen } from "../ui/on-screen";
import { Verdict } from "../ui/verdict";
import { ExpectationTable } from "./expectation-table";
import styles from "./gallery.module.css";
import { headlines } from "./headline";

interface GalleryEntryProps {
  card: GalleryCard;
  /** Whether the server still makes figures. */
  isMaking: boolean;
  onChanged(): void;
  /** Called when a good part of the card comes into view, and when it leaves. */
  onSight(id: string, isShown: boolean): void;
}

/** A scenario of the library: its figure, its claim with the measured values, and the two ways to run it. */
export function GalleryEntry({ card, isMaking, onChanged, onSight }: GalleryEntryProps) {
  const element = useRef<HTMLLIElement>(null);
  const isShown = useOnScreen(element);
  useEffect(() => {
    onSight(card.id, isShown);
    return () => onSight(card.id, false);
  }, [card.id, isShown, onSight]);
  const [starting, during] = useBusy();
  const drives = useMay("drive");
  const teaches = useMay("teach");
  const { title } = card;
  const underWay = isActive(card.state);

  const live = () =>
    during(async () => {
      openOwn((await api.createBench({ scenario: card.id, paused: false, quiet_lead: true })).id);
      setPage("bench");
    });
  const headless = () => api.startRun({ scenario: card.id }).then(onChanged, showError);

  return (
    <Box component="li" ref={element} className="column card" p={12} style={{ gap: 8 }}>
      <div className={styles.thumbnail}>
        {card.figure ? (
          <img src={`./api/v1/gallery/${card.id}/figure?v=${card.figure}`} alt={`Figure of ${title}`} loading="lazy" />
        ) : teaches && card.state === "done" && card.run ? (
          <img src={`./api/v1/runs/${card.run}/thumbnail`} alt={`Figure of ${title}`} loading="lazy" />
        ) : (
          !underWay && (
            <div className={`column note ${styles.wait}`} data-failed={card.problem !== ""}>
              {card.problem ? `No figure: ${card.problem}` : isMaking ? "Its figure is being made" : "Not measured yet"}
            </div>
          )
        )}
        {underWay && (
          <div className={`column note ${styles.wait}`}>
            {card.state === "queued" ? "waits for its turn" : "running"}
            <Progress value={card.progress * 100} size="sm" w="60%" aria-label={`Progress of ${title}`} />
          </div>
        )}
      </div>
      <div>
        <h2>
          <PlaceLink place={{ page: "gallery", item: card.id }}>{title}</PlaceLink>
        </h2>
        <small>
          {card.id}
          {card.source && ` · ${card.source}`}
        </small>
        {headlines(card).map(({ metric, figure, ours, printed }) => (
          <Box component="p" key={metric} mt={6}>
            {figure}: <b>ours {ours}</b> / printed {printed}
          </Box>
        ))}
        <Box component="p" mt={4} fz="sm">
          {card.claim || card.summary}
        </Box>
      </div>
      <ExpectationTable entries={card.expectations} verdict={card.verdict} />
      <Group component="footer" gap="4px 10px">
        <Verdict verdict={card.verdict} borneOut={card.ok === true} />
        <Box component="span" fz="xs" c={card.ok === false ? "var(--alarm)" : "dimmed"}>
          {card.ok === null || card.expectations.length === 0
            ? ""
            : card.ok
              ? "measured as expected"
              : "other than expected"}
        </Box>
        <Group gap={6} ml="auto" wrap="nowrap">
          {teaches && card.state === "done" && card.run && (
            <Button
              component="a"
              href={`./api/v1/runs/${card.run}/report`}
              target="_blank"
              variant="subtle"
              leftSection={<IconFileText size={15} />}
              aria-label={`Report of ${title}`}
            >
              Report
            </Button>
          )}
          {teaches && card.state !== "done" && (
            <Button
              leftSection={<IconPlayerTrackNext size={15} />}
              disabled={underWay}
              title="Headless, with report, trace and script; at lower priority than the live benches"
              onClick={headless}
              aria-label={`Run ${title} headless`}
            >
              Run
            </Button>
          )}
          {drives && card.study === null && (
            <Button
              variant="light"
              leftSection={<IconPlayerPlay size={15} />}
              title={teaches ? undefined : "It takes the place of your bench"}
              loading={starting}
              onClick={live}
              aria-label={`Open ${title} live`}
            >
              Live
            </Button>
          )}
        </Group>
      </Group>
    </Box>
  );
}
