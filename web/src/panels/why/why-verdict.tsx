import { Box, Button, Text } from "@mantine/core";
import type { Account, Turn } from "../../api/types";
import { pickSample } from "../../bench/why";
import { jump } from "../../ui/hover";
import { turnWords, whySentence } from "./why-sentence";

interface WhyVerdictProps {
  diagnoser: string;
  account: Account;
  turn: Turn | undefined;
}

/** The verdict of the bank in one sentence, the sample of its last turn, and the way there. */
export function WhyVerdict({ diagnoser, account, turn }: WhyVerdictProps) {
  const at = turn?.tick ?? null;
  const goThere = (tick: number) => {
    pickSample(diagnoser, tick);
    jump.to({ tick });
  };
  return (
    <>
      <Text inherit fz="md" fw={600} lh={1.35} textWrap="pretty">
        {whySentence(account, turn, account.tick)}
      </Text>
      <Box component="p" className="row" m="4px 0 8px" c="dimmed">
        <span>σ is the miss that its own filter expects. {turn && turnWords(turn, account.tick)}</span>
        <Button
          h="auto"
          mih={26}
          styles={{ label: { whiteSpace: "normal" } }}
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
