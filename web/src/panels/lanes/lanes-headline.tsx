import { Box, Tooltip } from "@mantine/core";
import { useCallback, useMemo } from "react";
import type { Score } from "../../api/types";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { useView } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import { Figure } from "../../ui/figure";
import { formatCount, formatNumber, formatPercent, formatSi } from "../../ui/format";
import { useLiveValues } from "../schematic/use-live-values";
import type { TruthSwitch } from "./delays";
import { FalseSwitches } from "./false-switches";
import styles from "./lanes.module.css";
import { WeightedEstimate } from "./weighted-estimate";

/** The figures of a diagnoser, to be read from the last row. */
export function LanesHeadline({ id, names, switches }: { id: string; names: string[]; switches: TruthSwitch[] }) {
  const score = useBench((s) => s.scores[id]);
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 0;
  const last = switches.at(-1);
  const winner = typeof score?.winner === "number" ? names[score.winner] : score?.winner;
  const unlabelled = useBench((s) => s.bench?.record?.labels.length === 0);
  const stopped = useBench((s) => s.bench?.state === "tripped");
  const right = score !== undefined && isRight(score);
  return (
    <dl className={styles.headline}>
      <div>
        <dt>
          <button type="button" className={styles.name} onClick={() => useView.setState({ card: `diagnosers.${id}` })}>
            {id.replaceAll("_", " ")} says
          </button>
        </dt>
        {stopped ? (
          <dd title={`The board has stopped. The last verdict was ${winner ? hypothesisWords(winner) : "none"}.`}>
            stopped
          </dd>
        ) : unlabelled ? (
          <dd className={styles.winner}>
            <Said id={id} names={names} />
          </dd>
        ) : (
          <dd className={styles.winner} data-right={right} title={winner}>
            {winner ? hypothesisWords(winner) : "–"}
            {score?.unexplained && <FitsNone least={score.least_nis} />}
          </dd>
        )}
      </div>
      {unlabelled && (
        <Figure name="truth" title="The record has no labels: the truth is not known, and there is no score.">
          not in the record
        </Figure>
      )}
      <Figure name={last?.isStartUp ? "start-up" : "delay"} title={last?.isStartUp ? START_UP : undefined}>
        <Delay last={last} dtMs={dtMs} />
      </Figure>
      <Figure name="correct">{score ? formatPercent(score.correct_fraction) : "–"}</Figure>
      <Figure name="false switches">{score ? <FalseSwitches score={score} /> : "–"}</Figure>
      <WeightedEstimate id={id} />
    </dl>
  );
}

/** The verdict itself, where no score has it. */
function Said({ id, names }: { id: string; names: string[] }) {
  const shown = useMemo(() => ({ winner: `${id}.winner` }), [id]);
  const say = useCallback(
    (_key: string, index: number) => (names[index] ? hypothesisWords(names[index]) : "–"),
    [names],
  );
  const live = useLiveValues(shown, say);
  return <output ref={live("winner")} />;
}

/** The meaning of a start-up. */
export const START_UP = "No fault has acted yet. This is the time that the diagnoser takes to settle.";

/** Whether a verdict agrees with the truth; where no hypothesis is true, none is right. */
export const isRight = ({ winner, truth, unexplained }: Score): boolean =>
  truth >= 0 && winner === truth && !unexplained;

function Delay({ last, dtMs }: { last: TruthSwitch | undefined; dtMs: number }) {
  if (!last) return "–";
  if (!last.findable) return "not among the hypotheses";
  if (last.delay === undefined) return "not found yet";
  if (last.delay === 0) return "said before";
  if (last.isStartUp) return formatSi(last.delay * dtMs, "ms", 3);
  return (
    <>
      <span className={styles.samples}>{formatCount(last.delay, "sample")} · </span>
      {formatSi(last.delay * dtMs, "ms", 3)}
    </>
  );
}

/** The residuals of the bank contradict its verdict. */
export function FitsNone({ least }: { least: number }) {
  const times = formatNumber(Math.sqrt(least), 1);
  return (
    <Tooltip
      multiline
      w={280}
      label={`Even the hypothesis that fits best misses by ${times} times what its filter expects. Something acts that is not in the list, or the assumed noise is too small.`}
    >
      <Box
        component="b"
        display="inline-block"
        ml={8}
        px={6}
        lh={1.3}
        bdrs={3}
        bg="var(--alarm)"
        c="var(--panel)"
        fz="xs"
      >
        fits none
      </Box>
    </Tooltip>
  );
}
