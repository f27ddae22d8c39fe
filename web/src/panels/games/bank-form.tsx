import { Box, Stack } from "@mantine/core";
import type { GameCard, Parameter } from "../../api/types";
import { setValue, useGame } from "../../bench/game";
import { send } from "../../bench/send";
import { ParameterRow } from "../card/parameter-row";

/** The bank of every game. */
const BANK = "diagnosers.kalman";

/** The assumptions of the bank, and its sixth hypothesis; live values change on the bench too. */
export function BankForm({ card, on }: { card: GameCard; on: boolean }) {
  const values = useGame((s) => s.values);
  const change = (name: string, value: unknown) => {
    if (typeof value !== "number") return;
    setValue(name, value);
    if (on && card.live.includes(name)) void send({ set: { [`${BANK}.${name}`]: value } });
  };
  const rows = (shown: readonly Parameter[]) =>
    shown.map((parameter) => (
      <ParameterRow
        key={parameter.name}
        parameter={{ ...parameter, live: true }}
        value={values[parameter.name] ?? parameter.default}
        staged={false}
        onChange={(value) => change(parameter.name, value)}
      />
    ));
  return (
    <Stack gap={8} maw="70ch">
      <Box component="h3" mt={4} fz="sm">
        Assumptions of the bank
      </Box>
      {rows(card.hand_in.filter(({ name }) => card.live.includes(name)))}
      <Box component="h3" mt={4} fz="sm">
        A sixth hypothesis
      </Box>
      {rows(card.hand_in.filter(({ name }) => !card.live.includes(name)))}
    </Stack>
  );
}
