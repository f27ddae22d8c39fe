import { useMemo, useRef } from "react";
import { useView } from "../../bench/view-store";
import { pickSample } from "../../bench/why";
import { useBench } from "../../stream/bench-store";
import { currentEvents } from "../../stream/current-events";
import { useScheme } from "../../ui/use-scheme";
import { truthSwitches } from "./delays";
import { LaneCanvas } from "./lane-canvas";
import { LaneTools } from "./lane-tools";
import styles from "./lanes.module.css";
import { LanesHeadline } from "./lanes-headline";
import { lanesLayout } from "./lanes-layout";
import { type LanesPicture, paintLanes } from "./paint-lanes";
import { printLanes } from "./print-lanes";
import type { LaneTime } from "./use-lane-time";

interface DiagnoserLanesProps {
  id: string;
  names: string[];
  time: LaneTime;
  onWindow(ms: number): void;
}

/** The lanes of one diagnoser: one for each hypothesis. */
export function DiagnoserLanes({ id, names, time, onWindow }: DiagnoserLanesProps) {
  const scheme = useScheme();
  const large = useView((s) => s.large);
  const picked = useView((s) => (s.sample?.diagnoser === id ? s.sample.tick : undefined));
  const events = useBench((s) => s.events);
  const fontSize = large ? 15 : 12;
  const switches = useMemo(() => truthSwitches(currentEvents(events), id), [events, id]);
  const unexplained = `${id}.unexplained`; // traces recorded earlier do not have it
  const withUnexplained = useBench((s) => s.bench?.signals.some(({ name }) => name === unexplained) ?? false);
  const signals = useMemo(
    () => [
      ...names.map((name) => `${id}.probability.${name}`),
      `${id}.winner`,
      `${id}.truth`,
      ...(withUnexplained ? [unexplained] : []),
    ],
    [id, names, withUnexplained, unexplained],
  );
  const shown = useRef<LanesPicture | undefined>(undefined);
  const paint = useMemo<Parameters<typeof LaneCanvas>[0]["paint"]>(
    () =>
      (ctx, { frame, span, width, height, hover }) => {
        shown.current = {
          frame,
          span,
          names,
          layout: lanesLayout(width, height, names.length, fontSize),
          scheme,
          fontSize,
          switches,
          withUnexplained,
          hover,
          picked,
        };
        paintLanes(ctx, shown.current);
      },
    [names, fontSize, scheme, switches, withUnexplained, picked],
  );
  const edges = lanesLayout(1000, 400, names.length, fontSize);

  return (
    <section className={styles.lanes} aria-label={`Diagnosis by ${id}`}>
      <div className={styles.toolbar}>
        <LanesHeadline id={id} names={names} switches={switches} />
        <LaneTools time={time} onWindow={onWindow} take={() => shown.current && printLanes(shown.current, id)} />
      </div>
      <LaneCanvas
        label={`Probability of ${names.join(", ")} over time`}
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
