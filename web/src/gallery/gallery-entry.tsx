import { Button, Progress } from "@mantine/core";
import { IconFileText, IconPlayerPlay, IconPlayerTrackNext } from "@tabler/icons-react";
import { useState } from "react";
import { api } from "../api/api";
import type { GalleryCard } from "../api/types";
import { openBench } from "../bench/open-bench";
import { showError } from "../bench/send";
import { setPage } from "../bench/view-store";
import { Verdict } from "../ui/verdict";
import { ExpectationTable } from "./expectation-table";
import styles from "./gallery.module.css";

/** A scenario of the library: its run as a drawing, its claim beside what was measured, and the two ways to run it. */
export function GalleryEntry({ card, onChanged }: { card: GalleryCard; onChanged(): void }) {
  const [starting, setStarting] = useState(false);
  const underWay = card.state === "queued" || card.state === "running";

  const live = async () => {
    setStarting(true);
    try {
      openBench((await api.createBench({ scenario: card.id, paused: false, quiet_lead: true })).id);
      setPage("bench");
    } catch (error) {
      showError(error);
      setStarting(false);
    }
  };
  const headless = () => api.startRun({ scenario: card.id }).then(onChanged, showError);

  return (
    <li className={styles.card}>
      <div className={styles.thumbnail}>
        {card.state === "done" && card.run ? (
          <img
            src={`./api/v1/runs/${card.run}/thumbnail`}
            alt={card.study ? "Measured figures on the bars expected" : "Displacement and verdicts over the run"}
            loading="lazy"
          />
        ) : underWay ? (
          <div className={styles.wait}>
            {card.state === "queued" ? "waits for its turn" : "running"}
            <Progress value={card.progress * 100} size="sm" w="60%" aria-label={`Progress of ${card.title}`} />
          </div>
        ) : (
          <div className={styles.wait}>{card.state === "new" ? "not run yet" : card.state}</div>
        )}
      </div>
      <div className={styles.words}>
        <h2>{card.title}</h2>
        <small>
          {card.id}
          {card.source && ` · ${card.source}`}
        </small>
        <p>{card.claim || card.summary}</p>
      </div>
      <ExpectationTable entries={card.expectations} verdict={card.verdict} />
      <footer>
        <Verdict verdict={card.verdict} borneOut={card.ok === true} />
        <span className={styles.ok} data-ok={card.ok}>
          {card.ok === null ? "" : card.ok ? "measured as expected" : "other than expected"}
        </span>
        <div className={styles.buttons}>
          {card.state === "done" && card.run && (
            <Button
              component="a"
              href={`./api/v1/runs/${card.run}/report`}
              target="_blank"
              size="compact-sm"
              variant="subtle"
              leftSection={<IconFileText size={15} />}
              aria-label={`Report of ${card.title}`}
            >
              Report
            </Button>
          )}
          {card.state !== "done" && (
            <Button
              size="compact-sm"
              variant="default"
              leftSection={<IconPlayerTrackNext size={15} />}
              disabled={underWay}
              onClick={headless}
              aria-label={`Run ${card.title} headless`}
            >
              Run
            </Button>
          )}
          {card.study === null && (
            <Button
              size="compact-sm"
              variant="light"
              leftSection={<IconPlayerPlay size={15} />}
              loading={starting}
              onClick={live}
              aria-label={`Open ${card.title} live`}
            >
              Live
            </Button>
          )}
        </div>
      </footer>
    </li>
  );
}
