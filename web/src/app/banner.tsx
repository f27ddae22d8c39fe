import { Button, CloseButton } from "@mantine/core";
import type { ReactNode } from "react";
import { useEffect, useState } from "react";
import { actions } from "../bench/actions";
import { showError } from "../bench/send";
import { useBench } from "../stream/bench-store";
import { stream } from "../stream/stream";
import { formatClock, formatTick } from "../ui/format";
import styles from "./banner.module.css";
import { openOwnBench, startAgain } from "./first-bench";
import { tryThis } from "./try-this";
import { useLasting } from "./use-lasting";

/** A connection that is back this soon was not worth a word. */
const BLINK_MS = 1000;
const HINT_KEY = "combbench.hint.seen";

/** One line under the header when something needs to be known: a trip, a lost connection, silence; else what to try. */
export function Banner({ hints = true }: { hints?: boolean }) {
  const connection = useBench((s) => s.connection);
  const trip = useBench((s) => (s.bench?.state === "tripped" ? s.bench.trip : undefined));
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const tip = useBench((s) => s.bench && tryThis(s.bench));
  const lost = useLasting(connection.phase === "waiting" && !connection.reason?.quiet, BLINK_MS);
  const [hint, setHint] = useState(() => localStorage.getItem(HINT_KEY) === null);

  if (connection.phase === "closed" && connection.reason)
    return (
      <Line tone="alarm" title={connection.reason.title} text={connection.reason.advice}>
        {connection.reason.offer === "bench" && <NewStart />}
        {connection.reason.offer === "reload" && (
          <Button size="compact-sm" onClick={() => window.location.reload()}>
            Reload
          </Button>
        )}
      </Line>
    );
  if (lost && connection.reason)
    return (
      <Line tone="alarm" title={connection.reason.title} text={connection.reason.advice}>
        <Countdown until={connection.retryAt} />
        <Button size="compact-sm" variant="default" onClick={stream.retry}>
          Try now
        </Button>
      </Line>
    );
  if (connection.staleSince && connection.phase === "open")
    return (
      <Line
        tone="warn"
        title={`Nothing heard since ${connection.staleSince.toLocaleTimeString()}`}
        text="What you see is that old. The page reconnects by itself if the server went away."
      />
    );
  if (trip)
    return (
      <Line
        tone="alarm"
        title={`Tripped: ${trip.reason.replace(/^tripped: /, "")}`}
        text={`at ${formatClock(trip.tick * dtMs)} s, ${formatTick(trip.tick)}. The voltage is off; what is shown are the last values before.`}
      >
        <Button size="compact-sm" color="alarm" onClick={actions.resetTrip}>
          Reset the trip
        </Button>
        <Button size="compact-sm" variant="default" onClick={actions.forkBeforeTrip}>
          Fork from before
        </Button>
        <Button size="compact-sm" variant="default" onClick={actions.reset}>
          Start over
        </Button>
      </Line>
    );
  if (hint && hints && tip)
    return (
      <Line tone="hint" title="Try this:" text={tip}>
        <CloseButton
          size="sm"
          aria-label="Dismiss the hint"
          onClick={() => {
            localStorage.setItem(HINT_KEY, "yes");
            setHint(false);
          }}
        />
      </Line>
    );
  return null;
}

function Line({
  tone,
  title,
  text,
  children,
}: {
  tone: "alarm" | "warn" | "hint";
  title: string;
  text: string;
  children?: ReactNode;
}) {
  return (
    // Announced by the page's live regions, not here a second time.
    <section className={styles.banner} data-tone={tone} aria-label="Notice">
      <strong>{title}</strong>
      <span>{text}</span>
      <div className={styles.actions}>{children}</div>
    </section>
  );
}

function Countdown({ until }: { until: number | undefined }) {
  const [now, setNow] = useState(performance.now());
  useEffect(() => {
    const timer = setInterval(() => setNow(performance.now()), 200);
    return () => clearInterval(timer);
  }, []);
  if (until === undefined) return null;
  const left = Math.ceil((until - now) / 1000);
  return <span className={styles.countdown}>{left > 0 ? `again in ${left} s` : "trying"}</span>;
}

/** What to do when the bench on the page is no more. */
function NewStart() {
  const scenario = useBench((s) => s.bench?.scenario_id);
  return (
    <>
      {scenario && (
        <Button size="compact-sm" onClick={() => startAgain(scenario).catch(showError)}>
          Start it again
        </Button>
      )}
      <Button
        size="compact-sm"
        variant={scenario ? "default" : "filled"}
        onClick={() => openOwnBench().catch(showError)}
      >
        Open my own
      </Button>
    </>
  );
}
