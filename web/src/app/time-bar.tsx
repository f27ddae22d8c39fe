import { Box, Button } from "@mantine/core";
import { IconArrowsDiff, IconGitBranch, IconPlayerTrackNextFilled } from "@tabler/icons-react";
import { useEffect, useState } from "react";
import { useMay } from "../api/me";
import type { Bench } from "../api/types";
import { useBehind } from "../bench/behind";
import { showPanel } from "../bench/dock";
import { eventTone } from "../bench/flag-words";
import { backToNow, lookBack } from "../bench/past";
import { send } from "../bench/send";
import { useBench } from "../stream/bench-store";
import { currentEvents } from "../stream/event-log";
import { staleWords, useStaleSince } from "../stream/freshness";
import { formatMoment, formatPercent } from "../ui/format";
import { Slider } from "../ui/slider";
import { BranchMenu } from "./branch-menu";
import { StripButton } from "./strip-button";
import styles from "./time-bar.module.css";

const MOST_MARKS = 200;
/** The ticks of one command. */
const MOST_STEP = 10_000;

/** The time of the bench: dragged back, all panels show that moment, and another future can begin there. */
export function TimeBar() {
  const bench = useBench((s) => s.bench);
  const mayBranch = useMay("branch");
  if (!bench || !mayBranch || bench.replay_of || bench.earliest_tick === null || bench.earliest_tick === undefined)
    return null;
  return <Bar bench={bench} first={bench.earliest_tick} />;
}

function Bar({ bench, first }: { bench: Bench; first: number }) {
  const events = useBench((s) => s.events);
  const isPast = Boolean(bench.origin?.is_past);
  const stale = useStaleSince();
  const [newest, setNewest] = useState({ of: bench.id, tick: bench.tick });
  const [held, setHeld] = useState<number | undefined>(undefined);
  // the bench continues while the page shows its past; the bar ends at the tick at which the page left it
  useEffect(() => {
    const of = isPast ? (bench.origin?.bench ?? "") : bench.id;
    setNewest((n) => ({ of, tick: isPast ? Math.max(n.of === of ? n.tick : 0, bench.tick) : bench.tick }));
  }, [bench, isPast]);
  const now = Math.max(isPast ? newest.tick : bench.tick, first + 1);
  const end = Math.max(now, bench.record?.samples ?? 0); // a record has a future to go to
  const shown = Math.min(held ?? bench.travel?.tick ?? bench.tick, end);
  const place = (tick: number) => `${((tick - first) / (end - first)) * 100}%`;
  const marks = (isPast ? events : currentEvents(events)).filter(
    (e) => e.tick >= first && e.tick <= end && eventTone(e) !== "quiet",
  );
  const go = (tick: number) => {
    setHeld(tick);
    if (tick >= now && isPast) void backToNow();
    else if (tick < now) lookBack(tick);
  };
  return (
    <section className={`line ${styles.timeline}`} data-of-bench="" data-past={isPast} aria-label="Timeline">
      <p>
        {stale ? (
          <strong>{staleWords(stale)}</strong>
        ) : (
          isPast && <strong>As it was at {formatMoment(shown * bench.dt_ms)}</strong>
        )}
        {bench.travel && (
          <span role="status"> computed again: {formatPercent(0.1 * Math.floor(10 * bench.travel.share), 0)}</span>
        )}
      </p>
      <Box pos="relative" flex="1 1 90px" miw={90} px={8}>
        <Slider
          size="sm"
          disabled={stale !== undefined}
          min={first}
          max={end}
          label={(tick) => formatMoment(tick * bench.dt_ms)}
          thumbLabel="Moment shown by all panels"
          value={shown}
          onChange={go}
          onChangeEnd={(tick) => {
            setHeld(undefined);
            if (bench.record && !isPast && tick > now) void stepTo(now, tick);
          }}
        />
        <span className={styles.marks} aria-hidden="true">
          {marks.slice(-MOST_MARKS).map((event) => (
            <i key={event.seq} data-tone={eventTone(event)} style={{ left: place(event.tick) }} title={event.text} />
          ))}
          {bench.origin && !isPast && <i data-tone="branch" style={{ left: place(bench.origin.tick) }} />}
        </span>
      </Box>
      <span className={styles.end}>{formatMoment(end * bench.dt_ms)}</span>
      <BranchMenu bench={bench} />
      {isPast ? <BackToNow /> : bench.origin && <Other />}
      <Compare />
    </section>
  );
}

/** Play a record on to a tick, at once; a command takes only so many ticks. */
async function stepTo(now: number, tick: number): Promise<void> {
  for (let from = now; from < tick; from += MOST_STEP)
    if (!(await send({ kind: "step", ticks: Math.min(MOST_STEP, tick - from) }))) return;
}

function BackToNow() {
  return (
    <Button variant="filled" leftSection={<IconPlayerTrackNextFilled size={14} />} onClick={() => void backToNow()}>
      Back to now
    </Button>
  );
}

/** From a branch to the bench it is of. */
function Other() {
  return (
    <StripButton
      icon={<IconGitBranch size={16} />}
      label="The other future"
      title="Show the bench that this one branched off"
      onClick={() => void backToNow()}
    />
  );
}

/** Opens the panel Compare, which chooses the benches behind the traces. */
function Compare() {
  const count = useBehind((s) => s.behind.length);
  return (
    <StripButton
      variant={count > 0 ? "light" : "default"}
      icon={<IconArrowsDiff size={16} />}
      label={count > 0 ? `Compared with ${count}` : "Compare"}
      onClick={() => showPanel("behind", "lanes")}
    />
  );
}
