import { useMemo } from "react";
import { useCatalog } from "../../api/use-catalog";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { useView } from "../../bench/view-store";
import { pickSample } from "../../bench/why";
import type { Box, Look, Pen } from "../../picture/pen";
import { useBench } from "../../stream/bench-store";
import { Figure } from "../../ui/figure";
import { formatPercent, formatSi } from "../../ui/format";
import type { Contestant } from "./contestants";
import { meanDelay, type TruthSwitch } from "./delays";
import { FalseSwitches } from "./false-switches";
import { LaneCanvas, type LaneShown } from "./lane-canvas";
import { FitsNone, isRight, START_UP } from "./lanes-headline";
import { paintRow, type RaceShown } from "./paint-race";
import styles from "./race.module.css";
import type { LaneTime } from "./use-lane-time";

interface RaceRowProps {
  contestant: Contestant;
  time: LaneTime;
  switches: TruthSwitch[];
  place: number | undefined;
  onPainted(id: string, shown: RaceShown): void;
}

const ORDINAL = ["", "1st", "2nd", "3rd"];

/** One diagnoser of the race. */
export function RaceRow({ contestant, time, switches, place, onPainted }: RaceRowProps) {
  const { id, names, probabilities, verdict, truth } = contestant;
  const picked = useView((s) => s.sample?.tick);
  const kind = useBench((s) => s.bench?.diagnosers[id]?.kind ?? "");
  const { block } = useCatalog();
  const signals = useMemo(
    () => [...probabilities, verdict, ...(truth ? [`${id}.truth`] : [])],
    [probabilities, verdict, truth, id],
  );
  const paint = useMemo(
    () => (pen: Pen, box: Box, now: LaneShown, look: Look) => {
      const shown = { ...now, names, switches, withTruth: truth, probabilities: probabilities.length, picked };
      paintRow(pen, box, shown, look);
      onPainted(id, shown);
    },
    [names, switches, truth, probabilities, picked, id, onPainted],
  );
  return (
    <section className={styles.row} aria-label={`Diagnosis by ${id}`}>
      <div className={`column ${styles.who}`}>
        <button
          type="button"
          className={styles.name}
          title={`${block("diagnose", kind)?.title ?? kind}: equations and parameters`}
          onClick={() => useView.setState({ card: `diagnosers.${id}` })}
        >
          {id.replaceAll("_", " ")}
        </button>
        <small>{block("diagnose", kind)?.title ?? kind.replaceAll("_", " ")}</small>
        <Verdict contestant={contestant} />
      </div>
      <div className={styles.field}>
        <LaneCanvas
          label={`${id}: ${names.join(", ")} over time`}
          signals={signals}
          time={time}
          left={0}
          right={0}
          paint={paint}
          onPick={truth ? (tick) => pickSample(id, tick) : undefined}
        />
      </div>
      <Figures id={id} switches={switches} place={place} />
    </section>
  );
}

function Verdict({ contestant: { id, names } }: { contestant: Contestant }) {
  const score = useBench((s) => s.scores[id]);
  if (!score) return null;
  return (
    <strong className={styles.verdict} title={names[score.winner]} data-right={isRight(score)}>
      {names[score.winner] === undefined ? "–" : hypothesisWords(names[score.winner])}
      {score.unexplained && <FitsNone least={score.least_nis} />}
    </strong>
  );
}

function lastDelay(last: TruthSwitch | undefined, dtMs: number): string {
  if (!last?.findable) return "–";
  if (last.delay === undefined) return "not yet";
  return last.delay === 0 ? "said before" : formatSi(last.delay * dtMs, "ms", 3);
}

/** The row's part of the scoreboard. */
function Figures({ id, switches, place }: { id: string; switches: TruthSwitch[]; place: number | undefined }) {
  const score = useBench((s) => s.scores[id]);
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  if (!score) return <dl className={styles.figures} />;
  const last = switches.at(-1);
  const mean = meanDelay(score.delays);
  return (
    <dl className={styles.figures}>
      <Figure name="correct">{formatPercent(score.correct_fraction)}</Figure>
      <Figure
        name={last?.isStartUp ? "start-up" : "last delay"}
        title={last?.isStartUp ? START_UP : undefined}
        data-place={place}
      >
        {lastDelay(last, dtMs)}
        {place !== undefined && <b>{ORDINAL[place] ?? `${place}th`}</b>}
      </Figure>
      <Figure name="mean delay">{mean === undefined ? "–" : formatSi(mean * dtMs, "ms", 3)}</Figure>
      <Figure name="false switches">
        <FalseSwitches score={score} />
      </Figure>
    </dl>
  );
}
