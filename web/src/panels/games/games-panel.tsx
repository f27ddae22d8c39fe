import { Box, Button, NativeSelect } from "@mantine/core";
import { useEffect } from "react";
import { games } from "../../api/games";
import { queryClient, useAnswer } from "../../api/queries";
import type { GameCard, GamePlay } from "../../api/types";
import { chooseGame, useGame } from "../../bench/game";
import { openOwn } from "../../bench/open-bench";
import { useBusy } from "../../bench/use-busy";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import exercise from "../../ui/exercise.module.css";
import { Figure } from "../../ui/figure";
import { formatCount, formatNumber } from "../../ui/format";
import { Formula } from "../../ui/formula";
import { jump } from "../../ui/hover";
import { NumberField } from "../../ui/number-field";
import { Stale } from "../../ui/stale";
import { BankForm } from "./bank-form";
import { FaultForm } from "./fault-form";
import { GameTable } from "./game-table";
import styles from "./games.module.css";

/** The table of a class grows while others play. */
const EVERY_MS = 5000;

/** Games with the bank: play on a bench with hidden values, hand in numbers, see points and the table. */
export function GamesPanel() {
  const { game, seed } = useGame();
  const cards = useAnswer(["games"], games.all);
  const { value, error, since, again } = useAnswer(
    ["game", game, seed],
    () => games.of(game, seed),
    () => EVERY_MS,
  );
  const playing = useBench((s) => s.bench?.blind?.game) ?? undefined;
  useEffect(() => {
    if (playing) chooseGame(playing.game, playing.seed);
  }, [playing]);
  const isBlind = useBench((s) => s.blind && !s.bench?.blind?.game);
  if (isBlind)
    return (
      <EmptyState title="A fault is hidden on this bench">
        Answer or give up under Lesson › Hidden fault; then you can play here.
      </EmptyState>
    );
  const card = cards.value?.find(({ id }) => id === game);
  const on = playing !== undefined && playing.game === game && playing.seed === seed;
  return (
    <section className={`view ${exercise.panel}`} aria-label="Games">
      <Stale error={error ?? cards.error} since={since} onRetry={again} />
      <div className={`row ${exercise.bar}`}>
        <NativeSelect
          aria-label="Game"
          value={game}
          data={(cards.value ?? []).map(({ id, title }) => ({ value: id, label: title }))}
          onChange={(e) => chooseGame(e.currentTarget.value, seed)}
        />
        <span className={exercise.field}>
          seed
          <NumberField
            label="Seed"
            unit=""
            integer
            value={seed}
            minimum={0}
            maximum={2 ** 53}
            onCommit={(chosen) => chooseGame(game, chosen)}
          />
        </span>
      </div>
      {card && value && <Play key={`${game} ${seed}`} card={card} play={value} on={on} />}
    </section>
  );
}

/** One game at one seed: its task, the bench, the hand-in, the outcome, the table. */
function Play({ card, play, on }: { card: GameCard; play: GamePlay; on: boolean }) {
  const { seed, values } = useGame();
  const [busy, during] = useBusy<"begin" | "judge">();
  const over = play.left === 0;
  const run = (what: "begin" | "judge", ask: () => Promise<GamePlay>) =>
    void during(async () => {
      const now = await ask();
      queryClient.setQueryData(["game", card.id, seed], now);
      if (what === "begin" && now.bench) openOwn(now.bench);
    }, what);
  const begin = () => {
    jump.to("live");
    run("begin", () => games.begin(card.id, seed, values));
  };
  const reveal = () => {
    if (window.confirm("Show the solution? You cannot hand in at this seed any more."))
      run("judge", () => games.reveal(card.id, seed));
  };
  const last = play.attempts.at(-1);
  const isBank = (play.kinds ?? []).length === 0;
  return (
    <>
      <p className={exercise.text}>{card.task}</p>
      <div className={`row ${exercise.bar}`}>
        <Button
          size="sm"
          variant={on || over ? "default" : "filled"}
          loading={busy === "begin"}
          disabled={busy === "judge" || over}
          onClick={begin}
        >
          {on ? "Begin again" : "Play on a new bench"}
        </Button>
        {on && isBank && (
          <Box component="small" maw="40ch">
            R, Q and the floor act on the bench at once; a new sixth hypothesis when you begin again.
          </Box>
        )}
      </div>
      {isBank ? <BankForm card={card} on={on} /> : <FaultForm kinds={play.kinds ?? []} on={on} />}
      <div className={`row ${exercise.bar}`}>
        <Button
          variant="filled"
          size="sm"
          loading={busy === "judge"}
          disabled={busy === "begin" || over}
          onClick={() => run("judge", () => games.handIn(card.id, seed, handedIn(play, values)))}
        >
          Hand in
        </Button>
        <Box component="small" maw="40ch">
          {over ? "No attempt left at this seed." : `${formatCount(play.left, "attempt")} left`}
        </Box>
        {over && (
          <Button variant="filled" size="sm" onClick={() => chooseGame(card.id, seed + 1)}>
            Next seed
          </Button>
        )}
        {!over && play.attempts.length > 0 && (
          <Button variant="subtle" disabled={busy !== undefined} onClick={reveal}>
            Show the solution
          </Button>
        )}
      </div>
      {last && (
        <Box pl={12} style={{ borderLeft: "3px solid var(--accent)" }} role="status">
          <Box component="p" maw="60ch" mb={8} fz="sm">
            {last.outcome.said}
            {play.best !== null && ` The best so far has ${formatNumber(play.best, 1)} points.`}
          </Box>
          <Formula latex={last.outcome.worked} />
        </Box>
      )}
      {play.hidden && (
        <dl className={styles.facts} aria-label="Solution">
          {play.hidden.map(({ name, said }) => (
            <Figure key={name} name={name}>
              {said}
            </Figure>
          ))}
        </dl>
      )}
      <GameTable card={card} play={play} />
      <details className={styles.rule} open={play.attempts.length === 0}>
        <summary>How points are counted</summary>
        <p className={exercise.text}>{card.rule}</p>
        {card.equations.map(({ label, latex }) => (
          <Formula key={label} latex={latex} />
        ))}
      </details>
    </>
  );
}

/** The values to hand in; a fault that was not chosen is the first one of the menu. */
const handedIn = ({ kinds = [] }: GamePlay, values: Record<string, number | string>) =>
  kinds.length > 0 ? { fault: kinds[0].name, ...values } : values;
