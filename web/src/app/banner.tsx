import { Box, Button } from "@mantine/core";
import { type ComponentProps, useEffect, useState } from "react";
import { useMay } from "../api/me";
import { actions } from "../bench/actions";
import { showPanel } from "../bench/dock";
import { showError } from "../bench/send";
import { useBench } from "../stream/bench-store";
import { staleWords, useStaleSince } from "../stream/freshness";
import { stream } from "../stream/stream";
import { formatClock, formatTick } from "../ui/format";
import { openOwnBench, startAgain } from "./first-bench";
import { NoticeLine } from "./notice-line";

const PLAYING = "Until it is over, the server hides the device, its noise and what happens to it.";
const HIDDEN = "Until you answer, the server hides everything that tells which.";

/** One line under the header when something needs to be known: a trip, a lost connection, silence, a hidden fault. */
export function Banner() {
  const connection = useBench((s) => s.connection);
  const trip = useBench((s) => (s.bench?.state === "tripped" ? s.bench.trip : undefined));
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const isStuck = useBench((s) => s.bench?.is_stuck);
  const blind = useBench((s) => s.blind);
  const playing = useBench((s) => s.bench?.blind?.game);
  const drives = useMay("drive");
  const mayBranch = useMay("branch");
  const stale = useStaleSince();

  if (connection.phase === "closed" && connection.reason)
    return (
      <Line tone="alarm" title={connection.reason.title} text={connection.reason.advice}>
        {connection.reason.offer === "bench" && drives && <NewStart />}
        {(connection.reason.offer === "reload" || connection.reason.offer === "login") && (
          <Button variant="filled" onClick={() => window.location.reload()}>
            Reload
          </Button>
        )}
      </Line>
    );
  if (stale && connection.phase === "waiting" && connection.reason && !connection.reason.quiet)
    return (
      <Line
        tone="alarm"
        title={connection.reason.title}
        text={`${capital(staleWords(stale))}. ${connection.reason.advice}`}
      >
        <Countdown until={connection.retryAt} />
        <Button onClick={stream.retry}>Try now</Button>
      </Line>
    );
  if (stale)
    return (
      <Line
        tone="warn"
        title={`Nothing heard, ${staleWords(stale)}`}
        text="The page shows the last values before, and reconnects by itself."
      />
    );
  if (isStuck)
    return (
      <Line
        tone="alarm"
        title="The server has to be restarted"
        text="Its engine hangs: no bench runs and no command is carried out. After a restart the benches come back."
      />
    );
  if (trip)
    return (
      <Line
        tone="alarm"
        title={`Tripped: ${trip.reason.replace(/^tripped: /, "")}`}
        text={`at ${formatClock(trip.tick * dtMs)} s, ${formatTick(trip.tick)}. The voltage is off; the panels show the last values before.`}
      >
        {drives && (
          <Button variant="filled" color="alarm" onClick={actions.resetTrip}>
            Reset the trip
          </Button>
        )}
        {mayBranch && <Button onClick={actions.forkBeforeTrip}>Fork from before</Button>}
        {drives && <Button onClick={actions.reset}>Start over</Button>}
      </Line>
    );
  if (!blind) return null;
  const [title, text, view, words] = playing
    ? [`A game is played here, seed ${playing.seed}`, PLAYING, "games", "Games"]
    : ["A fault is hidden here, or none", HIDDEN, "blind", "Answer"];
  return (
    <Line tone="warn" title={title} text={text}>
      {drives && <Button onClick={() => showPanel(view, "faults")}>{words}</Button>}
    </Line>
  );
}

const capital = (words: string): string => words.charAt(0).toUpperCase() + words.slice(1);

function Line(line: Omit<ComponentProps<typeof NoticeLine>, "label">) {
  // Announced by the page's live regions, not here a second time.
  return <NoticeLine label="Notice" isBrief={line.tone === "warn"} {...line} />;
}

function Countdown({ until }: { until: number | undefined }) {
  const [now, setNow] = useState(performance.now());
  useEffect(() => {
    const timer = setInterval(() => setNow(performance.now()), 200);
    return () => clearInterval(timer);
  }, []);
  if (until === undefined) return null;
  const left = Math.ceil((until - now) / 1000);
  return (
    <Box component="span" miw="9ch" c="dimmed">
      {left > 0 ? `again in ${left} s` : "trying"}
    </Box>
  );
}

/** What to do when the bench on the page is no more. */
function NewStart() {
  const scenario = useBench((s) => s.bench?.scenario_id);
  return (
    <>
      {scenario && (
        <Button variant="filled" onClick={() => startAgain(scenario).catch(showError)}>
          Start it again
        </Button>
      )}
      <Button variant={scenario ? "default" : "filled"} onClick={() => openOwnBench().catch(showError)}>
        Open my own
      </Button>
    </>
  );
}
