import { Box } from "@mantine/core";
import { useEffect, useState } from "react";
import type { Cue } from "../../api/types";
import { plannedTo, useLecture } from "../../bench/lecture";
import { formatIn, keepUnits } from "../../ui/format";
import styles from "./lecture.module.css";

const TICK_MS = 5000;

/** The words, questions and predictions of the speaker at a cue. */
export function Notes({ cue, next }: { cue: Cue; next: string | undefined }) {
  const others = [
    ["Ask", cue.ask],
    ["Watch for", cue.see],
    ["Vote (A opens it, X reveals it)", cue.vote?.text],
  ];
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: notes longer than their place are scrolled by keys
    <section className={styles.notes} aria-label="Notes of the speaker" tabIndex={0}>
      <div className={styles.columns}>
        {cue.say.split("\n").map((line) => (
          <p key={line}>{keepUnits(line)}</p>
        ))}
        {others.map(
          ([name, text]) =>
            text && (
              <p key={name}>
                <b>{name}: </b>
                {keepUnits(text)}
              </p>
            ),
        )}
        {next && (
          <Box component="p" c="dimmed">
            <b>Next: </b>
            {next}
          </Box>
        )}
      </div>
    </section>
  );
}

/** Minutes used, and how many are planned up to the end of this cue. */
export function LectureClock() {
  const planned = useLecture(({ lecture, at }) => (lecture ? plannedTo(lecture.script, at) : 0));
  const whole = useLecture(({ lecture }) => lecture?.minutes ?? 0);
  const began = useLecture((s) => s.began);
  const used = useMinutesSince(began);
  return <ClockFace used={used} planned={planned} whole={whole} />;
}

export function ClockFace({ used, planned, whole }: { used: number; planned: number; whole: number }) {
  return (
    <p className={`note ${styles.clock}`} data-late={used > planned}>
      {formatIn(used, "min", 1)} used
      <span>
        , {formatIn(planned, "min", 1)} planned to the end of this cue, {formatIn(whole, "min", 1)} in all
      </span>
    </p>
  );
}

export function useMinutesSince(began: number): number {
  const [now, setNow] = useState(Date.now);
  useEffect(() => {
    setNow(Date.now());
    const timer = setInterval(() => setNow(Date.now()), TICK_MS);
    return () => clearInterval(timer);
  }, []);
  return began ? Math.max(0, now - began) / 60_000 : 0;
}
