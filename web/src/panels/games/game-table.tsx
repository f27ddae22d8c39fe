import { Checkbox, NativeSelect } from "@mantine/core";
import { useState } from "react";
import { games } from "../../api/games";
import { useAnswer } from "../../api/queries";
import type { GameCard, GameLine, GamePlay, HandedIn } from "../../api/types";
import { useClasses } from "../../api/use-classes";
import exercise from "../../ui/exercise.module.css";
import { formatCount, formatNumber, formatShort } from "../../ui/format";
import { TableHead } from "../../ui/table-head";
import { parameterTitle } from "../card/parameter-title";
import { shownIn } from "./fault-form";
import styles from "./games.module.css";

const OWN = "";
const EVERY_MS = 5000;

/** Players and their points at this seed; a teacher chooses the class. */
export function GameTable({ card, play }: { card: GameCard; play: GamePlay }) {
  const { all } = useClasses();
  const [chosen, setChosen] = useState(OWN);
  const [tells, setTells] = useState(false);
  const group = all.find(({ id }) => id === chosen);
  const { value } = useAnswer(
    group ? ["game", card.id, play.seed, "of", group.id] : undefined,
    () => games.ofClass(group?.id ?? "", card.id, play.seed),
    () => EVERY_MS,
  );
  const lines = group ? (value?.table ?? []) : (play.table ?? []);
  const isTold = group ? tells : lines.some(({ handed_in }) => handed_in);
  return (
    <>
      {all.length > 0 && (
        <div className={`row ${exercise.bar}`}>
          <NativeSelect
            aria-label="Table of"
            value={chosen}
            data={[
              { value: OWN, label: "My own attempts" },
              ...all.map(({ id, name }) => ({ value: id, label: `Class ${name}` })),
            ]}
            onChange={(e) => setChosen(e.currentTarget.value)}
          />
          {group && (
            <Checkbox
              label="With the values handed in"
              checked={tells}
              onChange={(e) => setTells(e.currentTarget.checked)}
            />
          )}
        </div>
      )}
      {lines.length > 0 && (
        <table className={exercise.table}>
          <caption>
            {card.title}, seed {play.seed}: {formatCount(lines.length, "attempt")}
            {!group && !isAlone(lines) && play.left > 0 && "; the values of others are shown when your game is over"}
          </caption>
          <TableHead names={["Place", "Who", "Points", isTold && "Handed in", "When"]} />
          <tbody>
            {lines.map((line, place) => (
              <tr key={line.id} className={line.mine ? styles.mine : undefined}>
                <td>{place + 1}</td>
                <td>{line.name}</td>
                <td>{formatNumber(line.points, 1)}</td>
                {isTold && <td>{line.handed_in ? said(line.handed_in, card, play) : "–"}</td>}
                <td>{new Date(line.at).toLocaleTimeString([], { hour: "2-digit", minute: "2-digit" })}</td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
    </>
  );
}

const isAlone = (lines: readonly GameLine[]) => lines.every(({ mine }) => mine);

/** The values handed in, in one line: differences from the defaults. */
function said(handed: HandedIn, { hand_in }: GameCard, { kinds = [] }: GamePlay): string {
  const kind = kinds.find(({ name }) => name === handed.fault);
  if (kind) {
    const { factor, unit } = shownIn(kind);
    return `${kind.title.toLowerCase()} ${formatShort(Number(handed.severity) * factor, unit, 3)}`;
  }
  // another student is offered other faults
  if (handed.fault !== undefined)
    return `${String(handed.fault).replaceAll("_", " ")} ${formatShort(Number(handed.severity), "", 3)}`;
  const changed = hand_in.flatMap((parameter) => {
    const value = handed[parameter.name];
    if (typeof value !== "number" || value === parameter.default) return [];
    return [`${parameterTitle(parameter).toLowerCase()} ${formatShort(value, parameter.unit, 3)}`];
  });
  return changed.length > 0 ? changed.join(", ") : "as by default";
}
