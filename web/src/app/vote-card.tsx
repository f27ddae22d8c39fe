import { Button, Group, Stack } from "@mantine/core";
import { useEffect, useState } from "react";
import { ApiError } from "../api/client";
import { castVote, useMe } from "../api/me";
import type { OpenVote } from "../api/types";
import { announce } from "../bench/announce";
import { hypothesisWords } from "../bench/hypothesis-words";
import { showError } from "../bench/send";
import { formatCount, formatIn } from "../ui/format";
import { Slider } from "../ui/slider";
import { follow } from "./follow";

const LINE = { borderBottom: "1px solid var(--line)" };
/** The interval at which a student's page asks for a vote. */
const EVERY_MS = 4000;

/** The open vote of a student's class: one answer at a tap, and a moment, until the vote is closed. */
export function VoteCard() {
  const student = useMe((s) => s.me?.role === "student");
  const vote = useMe((s) => s.me?.vote);
  useEffect(() => {
    if (!student) return;
    const look = () => {
      if (document.visibilityState === "visible")
        follow().catch((error: unknown) => {
          if (!(error instanceof ApiError)) return; // the server does not answer; the stream says so
        });
    };
    const timer = setInterval(look, EVERY_MS);
    return () => clearInterval(timer);
  }, [student]);
  if (!student || !vote || (vote.state === "closed" && !vote.mine)) return null;
  return <Card key={vote.id} vote={vote} />;
}

function Card({ vote }: { vote: OpenVote }) {
  const { question, state, mine, results, right } = vote;
  const { when, answers } = question;
  const [at, setAt] = useState(mine?.at_ms ?? (when ? (when.from_ms + when.until_ms) / 2 : null));
  const nameOf = (answer: string) => (question.diagnoser ? hypothesisWords(answer) : answer);
  const open = state === "open";
  useEffect(() => {
    if (open) announce(`The teacher asks: ${question.text}`);
  }, [open, question.text]);
  const cast = (answer: number, moment: number | null) =>
    castVote(vote.id, answer, moment).then(() => announce(`Your answer: ${nameOf(answers[answer])}`), showError);
  return (
    <Stack component="section" flex="none" gap={6} p="8px 14px" bg="var(--raised)" style={LINE} aria-label="Vote">
      <h2>{question.text}</h2>
      <Group gap={6}>
        {answers.map((answer, i) => (
          <Button
            key={answer}
            size="sm"
            variant={mine?.answer === i ? "filled" : "default"}
            aria-pressed={mine?.answer === i}
            disabled={!open}
            onClick={() => cast(i, at)}
          >
            {nameOf(answer)}
            {results && `, ${formatCount(results[i].count, "vote")}`}
          </Button>
        ))}
      </Group>
      {when && open && at !== null && (
        <Stack gap={2} maw={480} pb={6} fz="sm">
          <span>When? {formatIn(at, "ms", 1)}</span>
          <Slider
            thumbLabel="When"
            label={null}
            min={when.from_ms}
            max={when.until_ms}
            step={(when.until_ms - when.from_ms) / 100}
            value={at}
            onChange={setAt}
            onChangeEnd={(value) => mine && cast(mine.answer, value)}
          />
        </Stack>
      )}
      <p className="note" role="status">
        {results
          ? right
            ? `The right answer: ${nameOf(right)}.`
            : "These are the answers."
          : !open
            ? "The vote is closed; the answer comes soon."
            : mine
              ? "Your answer is in. You can change it until the vote is closed."
              : "Tap to vote; votes are anonymous."}
      </p>
    </Stack>
  );
}
