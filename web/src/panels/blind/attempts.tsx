import { Box, Button } from "@mantine/core";
import { answersOf } from "../../api/blind";
import type { HiddenAnswer } from "../../api/types";
import { showPanel } from "../../bench/dock";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { useBench } from "../../stream/bench-store";
import exercise from "../../ui/exercise.module.css";
import { formatCount, formatNumber, formatPercent, formatSi } from "../../ui/format";
import { jump } from "../../ui/hover";
import { TableHead } from "../../ui/table-head";
import { Telling } from "./telling";

const RIGHT = "var(--running)";
const points = (value: number) => formatCount(Math.round(value), "point");

/** The outcome of the last question: truth, points, the verdicts of the diagnosers, and the way to the moment. */
export function Outcome({ answer }: { answer: HiddenAnswer }) {
  const { said, truth, confidence, came_tick, took_ms, verdicts = {}, points: won = 0 } = answer;
  const head = useBench((s) => s.bench?.tick) ?? 0;
  const known = answersOf(answer);
  const words = (name: string) => hypothesisWords(name, known);
  const right = said === truth;
  const when =
    came_tick === null
      ? "The device stayed healthy"
      : took_ms === null || took_ms === undefined
        ? "The fault had not come"
        : `The fault had been there for ${formatSi(took_ms, "ms", 3)}`;
  const told = Object.entries(verdicts).map(([id, verdict]) => `${id.replaceAll("_", " ")} said ${words(verdict)}`);
  return (
    <Box role="status" pb={8} style={{ borderBottom: "1px solid var(--line)" }}>
      <Box component="p" mb={4} fz="lg" fw={650} c={right ? RIGHT : "var(--alarm)"}>
        {said === null || said === undefined
          ? `No answer: it is ${words(truth)}.`
          : `${right ? "Right" : "Wrong"}: it is ${words(truth)}. ${points(won)}`}
      </Box>
      <p className={exercise.text}>
        {said && confidence !== null && confidence !== undefined
          ? `You said ${words(said)} with ${formatPercent(confidence, 0)}. `
          : ""}
        {when}; {told.join(", ")}.
      </p>
      <Telling answer={answer} />
      {came_tick !== null && came_tick <= head && (
        <Button m="8px 8px 0 0" onClick={() => jump.to({ tick: came_tick })}>
          Show the moment it came
        </Button>
      )}
      {answer.healthy && (
        <Button mt={8} onClick={() => showPanel("identify")}>
          Sweep the device
        </Button>
      )}
    </Box>
  );
}

/** All answers so far. */
export function Attempts({ answers }: { answers: readonly HiddenAnswer[] }) {
  const mean = answers.reduce((sum, one) => sum + (one.points ?? 0), 0) / answers.length;
  return (
    <table className={exercise.table}>
      <caption>
        {formatCount(answers.length, "answer")}, {points(mean)} on average
      </caption>
      <TableHead names={["Said", "Truth", "Sure", "Points"]} />
      <tbody>
        {answers.map((one) => {
          const known = answersOf(one);
          return (
            <tr key={one.id}>
              <td>{one.said ? hypothesisWords(one.said, known) : "nothing"}</td>
              <td>{hypothesisWords(one.truth, known)}</td>
              <td>
                {one.confidence === null || one.confidence === undefined ? "–" : formatPercent(one.confidence, 0)}
              </td>
              <Box component="td" {...(one.said === one.truth && { c: RIGHT, fw: 650 })}>
                {formatNumber(one.points ?? 0, 0)}
              </Box>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}
