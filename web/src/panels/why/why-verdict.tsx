import { Box, Button } from "@mantine/core";
import type { Account, Turn } from "../../api/types";
import { pickSample } from "../../bench/why";
import { jump } from "../../ui/hover";
import styles from "./why.module.css";
import { turnWords, whySentence } from "./why-sentence";

interface WhyVerdictProps {
  diagnoser: string;
  account: Account;
  turn: Turn | undefined;
}

/** What the bank says in one sentence, since when, and the way to where it turned, which the lanes show too. */
export function WhyVerdict({ diagnoser, account, turn }: WhyVerdictProps) {
  const at = turn?.tick ?? null;
  const goThere = (tick: number) => {
    pickSample(diagnoser, tick);
    jump.to({ tick });
  };
  return (
    <>
      <p className={styles.sentence}>{whySentence(account, turn, account.tick)}</p>
      <Box component="p" className="row" m="4px 0 8px" c="dimmed">
        <span>σ is the miss that its own filter expects. {turn && turnWords(turn, account.tick)}</span>
        <Button
          className={styles.wrapping}
          variant="light"
          disabled={at === null || at === account.tick}
          onClick={() => at !== null && goThere(at)}
        >
          The sample where it turned
        </Button>
      </Box>
    </>
  );
}
