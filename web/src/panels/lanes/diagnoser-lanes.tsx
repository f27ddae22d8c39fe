import { useMemo, useRef } from "react";
import { hypothesesExplained, hypothesisWords } from "../../bench/hypothesis-words";
import { useView } from "../../bench/view-store";
import { pickSample } from "../../bench/why";
import { textWidth } from "../../picture/svg-text";
import { useBench } from "../../stream/bench-store";
import { currentEvents } from "../../stream/event-log";
import { useSize } from "../../ui/use-canvas";
import { truthSwitches } from "./delays";
import { LaneCanvas } from "./lane-canvas";
import { LaneTools } from "./lane-tools";
import styles from "./lanes.module.css";
import { LanesHeadline } from "./lanes-headline";
import { lanesLayout, leastHeight } from "./lanes-layout";
import { type LanesShown, lanesPicture, paintLanes } from "./paint-lanes";
import { paintVotes, votesInWords } from "./paint-votes";
import type { LaneTime } from "./use-lane-time";
import { useRevealed } from "./use-revealed";

/** Most share of the panel for the words of the hypotheses; longer words give way to names. */
const WORDS_SHARE = 0.42;

interface DiagnoserLanesProps {
  id: string;
  names: string[];
  /** Whether the bench gives it the truth. */
  withTruth: boolean;
  time: LaneTime;
  onWindow(ms: number): void;
}

/** The lanes of one diagnoser: one for each hypothesis. */
export function DiagnoserLanes({ id, names, withTruth, time, onWindow }: DiagnoserLanesProps) {
  const picked = useView((s) => (s.sample?.diagnoser === id ? s.sample.tick : undefined));
  const events = useBench((s) => s.events);
  const fontSize = useView((s) => s.fontPx);
  const { element, size } = useSize<HTMLElement>();
  const diagnosers = useBench((s) => s.bench?.diagnosers);
  const switches = useMemo(() => truthSwitches(currentEvents(events), id), [events, id]);
  const votes = useRevealed(id, names);
  const unexplained = `${id}.unexplained`; // traces recorded earlier do not have it
  const withUnexplained = useBench((s) => s.bench?.signals.some(({ name }) => name === unexplained) ?? false);
  const signals = useMemo(
    () => [
      ...names.map((name) => `${id}.probability.${name}`),
      `${id}.winner`,
      ...(withTruth ? [`${id}.truth`] : []),
      ...(withUnexplained ? [unexplained] : []),
    ],
    [id, names, withTruth, withUnexplained, unexplained],
  );
  const { labels, left } = useMemo(() => {
    const words = names.map((name) => hypothesisWords(name, diagnosers));
    const widthOf = (texts: string[]) =>
      Math.max(...texts.map((text) => textWidth(text, fontSize, 700, "IBM Plex Sans Variable"))) + 22;
    const labels = widthOf(words) <= size.width * WORDS_SHARE ? words : names;
    return { labels, left: Math.max(fontSize * 6, widthOf(labels)) };
  }, [names, diagnosers, fontSize, size.width]);
  const shown = useRef<LanesShown | undefined>(undefined);
  const paint = useMemo<Parameters<typeof LaneCanvas>[0]["paint"]>(
    () => (pen, box, now, look) => {
      shown.current = { ...now, names, labels, gutter: left / fontSize, switches, withTruth, withUnexplained, picked };
      paintLanes(pen, box, shown.current, look);
      if (votes) paintVotes(pen, box, shown.current, look, votes);
    },
    [names, labels, left, fontSize, switches, withTruth, withUnexplained, picked, votes],
  );
  const edges = lanesLayout(1000, 400, names.length, fontSize, left);

  return (
    <section
      ref={element}
      className={`column ${styles.lanes}`}
      style={{ "--least": `${leastHeight(names.length, fontSize)}px` } as React.CSSProperties}
      aria-label={`Diagnosis by ${id}`}
    >
      <div className={`line ${styles.toolbar}`}>
        {withTruth && <LanesHeadline id={id} names={names} switches={switches} />}
        <LaneTools time={time} onWindow={onWindow} take={() => shown.current && lanesPicture(shown.current, id)} />
      </div>
      <LaneCanvas
        label={`Probability of ${labels.join(", ")} over time${votes ? `; ${votesInWords(votes, labels)}` : ""}`}
        legend={hypothesesExplained(names)}
        signals={signals}
        time={time}
        left={edges.left}
        right={1000 - edges.right}
        paint={paint}
        onPick={(tick) => pickSample(id, tick)}
      />
    </section>
  );
}
