import { useState } from "react";
import { useAnswer } from "../../api/queries";
import { sheets } from "../../api/sheets";
import { EmptyState } from "../../ui/empty-state";
import { SheetList } from "./sheet-list";
import { SheetPage } from "./sheet-page";

const EVERY_MS = 3000;

/** The lab sheet: the one begun last, or the list of all. */
export function SheetPanel() {
  const { value, again } = useAnswer(["sheets"], sheets.all, () => EVERY_MS);
  const [leftFor, setLeftFor] = useState<string | undefined>(undefined);
  if (!value) return <EmptyState title="Lab sheets">Loading the sheets…</EmptyState>;
  const current = value.current ?? undefined;
  if (current && leftFor !== current)
    return (
      <SheetPage
        id={current}
        onLeave={() => {
          setLeftFor(current);
          again();
        }}
      />
    );
  return (
    <SheetList
      cards={value.sheets}
      onChanged={() => {
        setLeftFor(undefined);
        again();
      }}
    />
  );
}
