import { type Ref, useCallback, useImperativeHandle, useMemo, useRef } from "react";
import { useView } from "../../bench/view-store";
import type { Box, Look, Pen } from "../../picture/pen";
import type { TakePicture } from "../../picture/picture-menu";
import { useBench } from "../../stream/bench-store";
import { currentEvents } from "../../stream/event-log";
import { timeUnit } from "../../ui/time-axis";
import type { Contestant } from "./contestants";
import { racePlaces, type TruthSwitch, truthSwitches } from "./delays";
import { LaneCanvas, type LaneShown } from "./lane-canvas";
import { paintHead, type RaceShown } from "./paint-race";
import styles from "./race.module.css";
import { racePicture } from "./race-picture";
import { RaceRow } from "./race-row";
import type { LaneTime } from "./use-lane-time";

const NONE: TruthSwitch[] = [];

interface RaceProps {
  contestants: Contestant[];
  time: LaneTime;
  picture: Ref<TakePicture>;
}

/** All diagnosers of the bench on one axis of time, under the truth, with delays and places. */
export function Race({ contestants, time, picture }: RaceProps) {
  const fontSize = useView((s) => s.fontPx);
  const events = useBench((s) => s.events);
  const switches = useMemo(() => {
    const current = currentEvents(events);
    return Object.fromEntries(contestants.map(({ id }) => [id, truthSwitches(current, id)]));
  }, [events, contestants]);
  const places = useMemo(() => racePlaces(switches), [switches]);
  const first = contestants.find((c) => c.truth);
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const unit = timeUnit(time.view.kind === "past" ? (time.view.end - time.view.start) * dtMs : time.windowMs).unit;
  const head = useRef<RaceShown | undefined>(undefined);
  const rows = useRef(new Map<string, RaceShown>());
  const keep = useCallback((id: string, row: RaceShown) => rows.current.set(id, row), []);
  useImperativeHandle(
    picture,
    () => () => {
      const shown = contestants.flatMap(({ id }) => {
        const row = rows.current.get(id);
        return row ? [{ id, row }] : [];
      });
      return racePicture(head.current, shown);
    },
    [contestants],
  );
  const truthSignals = useMemo(() => (first ? [`${first.id}.truth`] : []), [first]);
  const paint = useMemo(
    () => (pen: Pen, box: Box, now: LaneShown, look: Look) => {
      const names = first?.names ?? [];
      head.current = { ...now, names, switches: NONE, withTruth: true, probabilities: 0, picked: undefined };
      paintHead(pen, box, head.current, look);
    },
    [first],
  );
  return (
    <div className={styles.race} style={{ "--row": `${fontSize * 6.6}px` } as React.CSSProperties}>
      {first && (
        <div className={styles.head}>
          <span className={`column ${styles.truthName}`}>
            <i>{unit}</i>
            truth
          </span>
          <div className={styles.field} style={{ height: fontSize * 2 + 18 }}>
            <LaneCanvas
              label="The truth over time"
              signals={truthSignals}
              time={time}
              left={0}
              right={0}
              paint={paint}
            />
          </div>
          <span className={styles.figuresName}>score</span>
        </div>
      )}
      {contestants.map((contestant) => (
        <RaceRow
          key={contestant.id}
          contestant={contestant}
          time={time}
          switches={switches[contestant.id] ?? NONE}
          place={places[contestant.id]}
          onPainted={keep}
        />
      ))}
    </div>
  );
}
