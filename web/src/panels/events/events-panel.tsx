import { ActionIcon, Box, SegmentedControl } from "@mantine/core";
import { IconGitBranch } from "@tabler/icons-react";
import { useState } from "react";
import { classes } from "../../api/classes";
import { useMay, useServed } from "../../api/me";
import { useList } from "../../api/queries";
import type { LogEntry } from "../../api/types";
import { useClasses } from "../../api/use-classes";
import { eventTone } from "../../bench/flag-words";
import { goOnWithout } from "../../bench/past";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatMoment, formatTick } from "../../ui/format";
import { jump } from "../../ui/hover";
import { ShowOlder } from "../../ui/show-older";
import { Stale } from "../../ui/stale";
import { CopyMenu } from "./copy-menu";
import styles from "./events.module.css";

/** Events that are shown at first, and that are added each time. */
const SHOWN = 300;

/** Everything that happened, numbered, newest first; a click takes the scopes there. */
export function EventsPanel() {
  const bench = useBench((s) => s.bench?.id);
  const shared = useBench((s) => Boolean(s.bench?.company));
  const classes = useClasses().all.length > 0;
  const teaches = useMay("teach");
  const [who, setWho] = useState(false);
  if (!bench || !teaches || !(shared || classes || who)) return <Events />;
  return (
    <div className="view">
      <SegmentedControl
        flex="none"
        m="6px 9px 0"
        style={{ alignSelf: "flex-start" }}
        aria-label="Contents of the list"
        data={[
          { value: "what", label: "What happened" },
          { value: "who", label: "Who did what" },
        ]}
        value={who ? "who" : "what"}
        onChange={(value) => setWho(value === "who")}
      />
      {who ? <WhoDid bench={bench} /> : <Events />}
    </div>
  );
}

/** Kinds of events that a branch can be without. */
const CHANGES = new Set(["inject", "heal", "set", "switch"]);

function Events() {
  const events = useBench((s) => s.events);
  const [shown, setShown] = useState(SHOWN);
  const earliest = useBench((s) => s.bench?.earliest_tick);
  const mayBranch = useMay("branch");
  const served = useServed();
  const canBranch = ({ kind, tick }: LogEntry) =>
    mayBranch && CHANGES.has(kind) && earliest !== null && earliest !== undefined && tick >= earliest;
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  if (events.length === 0)
    return (
      <EmptyState title="Nothing has happened yet">
        Every command, fault, finding and trip is listed here with its tick.
      </EmptyState>
    );
  return (
    <ol className={styles.list} aria-label="Events, newest first">
      {events
        .slice(-shown)
        .reverse()
        .map((event) => (
          <Box component="li" key={event.seq} className="line" pr={8}>
            <button
              type="button"
              className={`${styles.entry} ${styles.event}`}
              data-tone={eventTone(event)}
              onClick={() => jump.to({ tick: event.tick })}
              title={`Tick ${event.tick}: show it on the scopes`}
            >
              <span className={styles.number}>{event.seq}</span>
              <span className={styles.time}>{formatMoment(event.tick * dtMs)}</span>
              <span className={styles.text}>{event.text}</span>
              <small>{event.actor}</small>
            </button>
            {event.command && served && <CopyMenu event={event} />}
            {canBranch(event) && (
              <ActionIcon
                size="sm"
                aria-label={`Branch without this: ${event.text}`}
                title="Continue on a new bench from just before, without this"
                onClick={() => void goOnWithout(event.tick, event.text)}
              >
                <IconGitBranch size={14} />
              </ActionIcon>
            )}
          </Box>
        ))}
      {events.length > shown && (
        <li>
          <ShowOlder more={() => setShown(shown + SHOWN)} />
        </li>
      )}
    </ol>
  );
}

const EVERY_MS = 3000;

/** Actions of users on a bench, drivers and arrivals, newest first; the list outlives the bench. */
function WhoDid({ bench }: { bench: string }) {
  const { value, error, since, again, more } = useList(
    ["bench-audit", bench],
    (most) => classes.benchAudit(bench, most),
    () => EVERY_MS,
  );
  return (
    <>
      <Stale error={error} since={since} onRetry={again} />
      {value?.length === 0 && <EmptyState title="Nothing yet">Actions on this bench are listed here.</EmptyState>}
      <ol className={styles.list} aria-label="Who did what, newest first">
        {value?.map(({ at, actor, text, tick }) => (
          <li key={`${at} ${actor} ${text}`} className={styles.did}>
            <time className="note" dateTime={at}>
              {new Date(at).toLocaleTimeString()}
            </time>
            <span className={styles.text}>
              <b>{actor}</b>: {text}
            </span>
            <small>{tick !== null && formatTick(tick)}</small>
          </li>
        ))}
      </ol>
      <ShowOlder more={more} />
    </>
  );
}
