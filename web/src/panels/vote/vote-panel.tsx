import { Box, Button, Group, NativeSelect, NumberInput, Textarea, TextInput } from "@mantine/core";
import { type ReactNode, useEffect, useState } from "react";
import { classes } from "../../api/classes";
import { useMay } from "../../api/me";
import { useAnswer } from "../../api/queries";
import type { NewVote, Vote } from "../../api/types";
import { votes } from "../../api/votes";
import { diagnoserWords, hypothesisWords } from "../../bench/hypothesis-words";
import { useLecture } from "../../bench/lecture";
import { showError } from "../../bench/send";
import { showVote } from "../../bench/vote";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { formatCount, formatPercent, formatShort } from "../../ui/format";
import styles from "./vote.module.css";

const EVERY_MS = 2000;
const ROOM = "";

/** Ask the class before the event: the question, the number of votes, then the results. */
export function VotePanel() {
  const teaches = useMay("teach");
  return teaches ? <Teachers /> : <EmptyState title="Votes">The teacher asks; the question appears here.</EmptyState>;
}

function Teachers() {
  const { value: groups } = useAnswer(["classes"], classes.all, () => 15_000);
  const { value: all, again } = useAnswer(["votes"], votes.all, () => EVERY_MS);
  const [chosen, setGroup] = useState<string | undefined>(undefined);
  const group = chosen ?? groups?.[0]?.id ?? ROOM;
  const vote = all?.find((one) => (one.class_id ?? ROOM) === group);
  useEffect(() => showVote(vote), [vote]);
  const run = (what: Promise<unknown>) => what.then(again, showError);
  if (!groups || !all) return null;
  const who = groups.length > 0 && (
    <NativeSelect
      label="Who votes"
      value={group}
      data={[
        ...groups.map(({ id, name }) => ({ value: id, label: name })),
        { value: ROOM, label: "Hands in the room" },
      ]}
      onChange={(e) => setGroup(e.currentTarget.value)}
    />
  );
  if (!vote)
    return (
      <div className={`view ${styles.panel}`}>
        <Ask group={group} who={who} run={run} />
      </div>
    );
  return (
    <div className={`view ${styles.panel}`}>
      <Running key={vote.id} vote={vote} students={groups.find(({ id }) => id === group)?.students} run={run} />
      {who}
    </div>
  );
}

/** A question to ask: from the cue of a lecture, or a new one. */
function Ask({ group, who, run }: { group: string; who: ReactNode; run(what: Promise<unknown>): void }) {
  const cue = useLecture(({ lecture, at }) => lecture?.script[at]?.vote ?? undefined);
  const diagnosers = useBench((s) => s.bench?.diagnosers) ?? {};
  const tick = useBench((s) => s.bench?.tick) ?? 0;
  const dtMs = useBench((s) => s.bench?.dt_ms) ?? 1;
  const [first] = Object.keys(diagnosers);
  const [text, setText] = useState(cue?.text ?? "Which lane rises, and when?");
  const [of, setOf] = useState(cue ? (cue.diagnoser ?? "") : (first ?? ""));
  const [words, setWords] = useState((cue?.answers ?? []).join("\n"));
  const lanes = of ? (diagnosers[of]?.names ?? []) : [];
  const answers = of
    ? lanes
    : words
        .split("\n")
        .map((word) => word.trim())
        .filter(Boolean);
  const now = tick * dtMs;
  const body: NewVote = {
    class_id: group || null,
    text,
    answers,
    diagnoser: of,
    when: of ? (cue?.when ?? { from_ms: now, until_ms: now + 20 }) : null,
    right: cue?.right && answers.includes(cue.right) ? cue.right : "",
  };
  return (
    <>
      <TextInput size="sm" label="Question" value={text} onChange={(e) => setText(e.currentTarget.value)} />
      <div className={styles.pair}>
        {who}
        <NativeSelect
          label="Answers"
          value={of}
          data={[
            ...Object.keys(diagnosers).map((id) => ({
              value: id,
              label: `the lanes of ${diagnoserWords(id, diagnosers)}`,
            })),
            { value: "", label: "two to six of my own" },
          ]}
          onChange={(e) => setOf(e.currentTarget.value)}
        />
      </div>
      {of === "" && (
        <Textarea
          autosize
          minRows={2}
          label="One answer in each line"
          value={words}
          onChange={(e) => setWords(e.currentTarget.value)}
        />
      )}
      {body.when && (
        <p className="note">
          Each answer has a moment, too: {formatShort(body.when.from_ms, "ms")} to{" "}
          {formatShort(body.when.until_ms, "ms")} of device time.
        </p>
      )}
      <Button
        variant="filled"
        size="sm"
        disabled={!text.trim() || answers.length < 2}
        onClick={() => run(votes.open(body))}
      >
        Open the vote
      </Button>
    </>
  );
}

interface RunningProps {
  vote: Vote;
  students: number | undefined;
  run(what: Promise<unknown>): void;
}

function Running({ vote, students, run }: RunningProps) {
  const { id, question, state, results, voted, right } = vote;
  const names = question.diagnoser ? question.answers.map((name) => hypothesisWords(name)) : question.answers;
  const [hands, setHands] = useState(question.answers.map(() => 0));
  const inRoom = vote.class_id === null && !results;
  const count = (i: number, value: number) => {
    const next = hands.map((hand, at) => (at === i ? value : hand));
    setHands(next);
    run(votes.count(id, next));
  };
  return (
    <>
      <Box component="h3" fz="lg" lh={1.3}>
        {question.text}
      </Box>
      <Box component="p" fz="xl" role="status">
        {vote.class_id === null
          ? `${formatCount(voted, "hand")} counted`
          : `${voted} of ${students ?? "?"} have voted${state === "open" ? "" : "; closed"}`}
      </Box>
      <Group gap={6}>
        {!results && (
          <Button variant="filled" size="sm" onClick={() => run(votes.reveal(id))}>
            Reveal
          </Button>
        )}
        {state === "open" && vote.class_id !== null && (
          <Button size="sm" onClick={() => run(votes.close(id))}>
            Close
          </Button>
        )}
        <Button size="sm" variant="subtle" onClick={() => run(votes.remove(id))}>
          {results ? "Another question" : "Take it back"}
        </Button>
      </Group>
      <ul className={styles.answers} aria-label={results ? "Results" : "Answers"}>
        {names.map((name, i) => (
          <Box component="li" key={name} fw={results !== null && right === question.answers[i] ? 650 : undefined}>
            {inRoom ? (
              <NumberInput
                label={name}
                min={0}
                max={10_000}
                value={hands[i]}
                onChange={(value) => typeof value === "number" && count(i, value)}
              />
            ) : (
              <span>
                {name}
                {results && right === question.answers[i] && <small> right</small>}
              </span>
            )}
            {results && (
              <>
                <meter min={0} max={Math.max(1, voted)} value={results[i].count} aria-label={`Votes for ${name}`} />
                <span>
                  {formatCount(results[i].count, "vote")}, {formatPercent(results[i].count / Math.max(1, voted), 0)}
                </span>
              </>
            )}
          </Box>
        ))}
      </ul>
      {results && question.diagnoser && (
        <p className="note">The bars are drawn over the lanes, with a mark at each guessed moment.</p>
      )}
    </>
  );
}
