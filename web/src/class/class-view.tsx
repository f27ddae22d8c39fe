import { Box, Button, Group, NativeSelect, Stack, TextInput } from "@mantine/core";
import { type ReactNode, useCallback, useMemo, useState } from "react";
import { classes } from "../api/classes";
import { useAnswer } from "../api/queries";
import type { Class, Tile } from "../api/types";
import { useCatalog } from "../api/use-catalog";
import { openBench } from "../bench/open-bench";
import { PageHead } from "../bench/page-head";
import { showError } from "../bench/send";
import { setPage } from "../bench/view-store";
import { useBench } from "../stream/bench-store";
import { EmptyState } from "../ui/empty-state";
import { formatCount, formatNumber } from "../ui/format";
import { Stale } from "../ui/stale";
import styles from "./class.module.css";
import { DoneSheet } from "./done-sheet";
import { ForAll } from "./for-all";
import { clock, Joining } from "./joining";
import { arranged, ORDERS, type Order } from "./members";
import { TileView } from "./tile-view";

const EVERY_MS = 1000;
const NONE: Tile[] = [];

interface ClassViewProps {
  group: Class;
  onChanged(): void;
  /** What chooses among classes. */
  children: ReactNode;
}

/** A class: its join code, the commands for all, and a tile for each student. */
export function ClassView({ group, onChanged, children }: ClassViewProps) {
  const { id, name, until, shown } = group;
  const here = useBench((s) => s.bench);
  const answer = useAnswer(
    ["members", id],
    () => classes.members(id),
    () => EVERY_MS,
  );
  const { value: members = NONE, error, since, again } = answer;
  const { blocks } = useCatalog();
  const [order, setOrder] = useState<Order>("hand");
  const [words, setWords] = useState("");
  const [picked, setPicked] = useState<ReadonlySet<string>>(new Set());
  const [log, setLog] = useState(false);
  const tiles = useMemo(() => arranged(members, order, words), [members, order, words]);
  const chosen = members.filter((tile) => picked.has(tile.id)).map((tile) => tile.id);
  const owners = useMemo(() => new Map(members.map((tile) => [tile.bench ?? "", tile.name])), [members]);

  // the bench of a student is not lent to another
  const own = here && !owners.has(here.id) ? here.id : undefined;

  const choose = useCallback(
    (member: string, isChosen: boolean) =>
      setPicked((before) => new Set(isChosen ? [...before, member] : [...before].filter((one) => one !== member))),
    [],
  );
  const actions = useMemo(
    () => ({
      choose,
      open: (tile: Tile) => {
        if (!tile.bench) return;
        setPage("bench"); // back leads here again
        openBench(tile.bench, true);
      },
      run: (tile: Tile, start: boolean) =>
        void classes.command(id, { kind: start ? "start" : "pause" }, [tile.id]).then(again, showError),
      lowerHand: (tile: Tile) => void classes.lowerHand(id, tile.id).then(again, showError),
      lend: own
        ? (tile: Tile) => void classes.drive(own, "hand_over", tile.id).then(() => setPage("bench"), showError)
        : undefined,
      sendAway: (tile: Tile) => {
        if (window.confirm(`Send ${tile.name} away? The bench is closed. The student can join again with the code.`))
          void classes.sendAway(id, tile.id).then(again, showError);
      },
    }),
    [id, again, choose, own],
  );
  const end = () => {
    if (
      window.confirm(
        `End the class ${name}? The names of its students, their benches and the log are deleted for good.`,
      )
    )
      void classes.end(id).then(onChanged, showError);
  };

  const hands = members.filter((tile) => tile.hand).length;
  const tripped = members.filter((tile) => tile.state === "tripped").map((tile) => tile.id);
  return (
    <>
      <Group component="header" className="card" gap="4px 16px" p="8px 12px">
        <PageHead name="Class" item={name} heading={name} />
        <Box component="p" flex={1} miw={180} c="dimmed">
          {formatCount(members.length, "student")}
          {hands > 0 && (
            <Box component="b" c="var(--accent)">
              {" "}
              · {formatCount(hands, "hand")} up
            </Box>
          )}
          {tripped.length > 0 && (
            <Box component="b" c="var(--alarm)">
              {" "}
              · {formatNumber(tripped.length, 0)} tripped
            </Box>
          )}{" "}
          · ends {clock(until)}
        </Box>
        <Group gap={8}>
          {children}
          {here && shown !== here.id && (
            <Button
              size="xs"
              title={`The bench on your page: ${here.title}`}
              onClick={() => void classes.show(id, here.id).then(onChanged, showError)}
            >
              Show my bench to all
            </Button>
          )}
          <Button size="xs" onClick={() => setLog(true)}>
            Activity
          </Button>
          <Button size="xs" onClick={end}>
            End the class…
          </Button>
        </Group>
      </Group>
      {shown && (
        <Group component="p" className="card" gap="4px 12px" p="6px 12px">
          <Box component="b" c="var(--accent)">
            All see one bench{shown === here?.id ? `: ${here.title}` : ""}.
          </Box>{" "}
          Their own benches keep running.
          <Button variant="filled" size="xs" onClick={() => void classes.endShowing(id).then(onChanged, showError)}>
            End showing
          </Button>
        </Group>
      )}
      <Joining group={group} isBrief={members.length > 0} onChanged={onChanged} />
      <ForAll
        group={id}
        count={members.length}
        chosen={chosen}
        tripped={tripped}
        onChooseNone={() => setPicked(new Set())}
        onDone={again}
      />
      <Stale error={error} since={since} onRetry={again} />
      {members.length === 0 ? (
        <section aria-label="Students">
          <EmptyState title="No student has joined yet">
            Show the code on the wall. Students appear here when they join.
          </EmptyState>
        </section>
      ) : (
        <Stack component="section" flex="none" gap={6} aria-label="Students">
          <Group gap={8}>
            <TextInput
              type="search"
              aria-label="Search students"
              placeholder="Name"
              value={words}
              onChange={(e) => setWords(e.currentTarget.value)}
            />
            <NativeSelect
              aria-label="Order"
              value={order}
              data={Object.entries(ORDERS).map(([value, label]) => ({ value, label }))}
              onChange={(e) => setOrder(e.currentTarget.value as Order)}
            />
          </Group>
          <ul className={styles.grid} data-stale={error !== undefined}>
            {tiles.map((tile) => (
              <TileView
                key={tile.id}
                tile={tile}
                isChosen={picked.has(tile.id)}
                hasCatalog={blocks.length > 0}
                actions={actions}
              />
            ))}
          </ul>
          {tiles.length === 0 && <EmptyState title="No student of this name">Search for fewer letters.</EmptyState>}
        </Stack>
      )}
      <DoneSheet opened={log} group={id} owners={owners} onClose={() => setLog(false)} />
    </>
  );
}
