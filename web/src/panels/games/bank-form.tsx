import type { GameCard, Parameter } from "../../api/types";
import { setValue, useGame } from "../../bench/game";
import { send } from "../../bench/send";
import { ParameterRow } from "../card/parameter-row";
import styles from "./games.module.css";

/** The bank of every game. */
const BANK = "diagnosers.kalman";

/** What the bank assumes, and its sixth hypothesis; what may turn live is turned on the bench too. */
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
    <div className={`column ${styles.form}`}>
      <h3>What the bank assumes</h3>
      {rows(card.hand_in.filter(({ name }) => card.live.includes(name)))}
      <h3>A sixth hypothesis</h3>
      {rows(card.hand_in.filter(({ name }) => !card.live.includes(name)))}
    </div>
  );
}
