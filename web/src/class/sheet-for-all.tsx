import { Button, NativeSelect } from "@mantine/core";
import { useState } from "react";
import { useAnswer } from "../api/queries";
import { sheets } from "../api/sheets";
import type { Outcomes } from "../api/types";
import { CHOICE, GroupForAll } from "./group-for-all";

interface SheetForAllProps {
  group: string;
  count: number;
  /** Ids of the chosen students; an empty list means all. */
  chosen: readonly string[];
  busy: boolean;
  onBegin(title: string, asked: () => Promise<Outcomes>): void;
}

/** A lab sheet for all students or for the chosen ones, and their points as files. */
export function SheetForAll({ group, count, chosen, busy, onBegin }: SheetForAllProps) {
  const { value } = useAnswer(["sheets"], sheets.all);
  const [wanted, setWanted] = useState<string | undefined>(undefined);
  const cards = value?.sheets ?? [];
  const card = cards.find(({ id }) => id === wanted) ?? cards[0];
  if (!card) return null;
  const whom = chosen.length > 0 ? `the ${chosen.length} chosen benches` : `all ${count} benches`;
  const late = chosen.length > 0 ? "" : " Students who join later begin it too.";
  const begin = () => {
    if (!window.confirm(`Begin the sheet ${card.title} on ${whom}? What is on them now is gone; answers stay.${late}`))
      return;
    onBegin(card.title, () => sheets.forAll(group, card.id, chosen.length > 0 ? [...chosen] : null));
  };
  return (
    <GroupForAll name="Lab sheet" label="A lab sheet for all">
      <NativeSelect
        {...CHOICE}
        aria-label="Lab sheet"
        value={card.id}
        data={cards.map(({ id, title }) => ({ value: id, label: title }))}
        onChange={(e) => setWanted(e.currentTarget.value)}
      />
      <Button size="xs" disabled={count === 0 || busy} onClick={begin}>
        {chosen.length > 0 ? "Begin sheet" : "Begin sheet on all"}
      </Button>
      <Button component="a" size="xs" variant="subtle" href={sheets.grades(group, "csv")} download>
        Points, CSV
      </Button>
      <Button component="a" size="xs" variant="subtle" href={sheets.grades(group, "json")} download="points.json">
        JSON
      </Button>
    </GroupForAll>
  );
}
