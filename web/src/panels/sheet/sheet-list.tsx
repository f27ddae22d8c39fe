import { Box, Button, FileButton } from "@mantine/core";
import { useState } from "react";
import { ApiError } from "../../api/client";
import { useMay } from "../../api/me";
import { sheets } from "../../api/sheets";
import type { SheetCard } from "../../api/types";
import { showError } from "../../bench/send";
import { sheetWords } from "../../bench/sheet-words";
import { useBusy } from "../../bench/use-busy";
import { formatCount, formatShort } from "../../ui/format";
import { beginSheet } from "./begin";
import styles from "./sheet.module.css";

/** All sheets; a sheet begins here, and a teacher opens sheets of the class here. */
export function SheetList({ cards, onChanged }: { cards: SheetCard[]; onChanged(): void }) {
  const teaches = useMay("teach");
  const drives = useMay("drive");
  const [busy, during] = useBusy<string>();
  const begin = (id: string) =>
    during(async () => {
      await beginSheet(id);
      onChanged();
    }, id);
  const remove = async ({ id, title }: SheetCard) => {
    if (!window.confirm(`Delete ${title}? Its answers are deleted too.`)) return;
    await sheets.remove(id).then(onChanged, showError);
  };
  return (
    <section className={`view ${styles.sheet}`} aria-label="Lab sheets">
      {!teaches && <p className="note">A sheet begins with a bench of its own, in place of yours.</p>}
      <Box component="ul" className="column" style={{ gap: 14 }}>
        {cards.map((card) => (
          <Box component="li" key={card.id} display="flex" style={{ gap: 10, alignItems: "flex-start" }}>
            <Box flex={1} miw={0}>
              <h3>{card.title}</h3>
              <Box component="p" fz="sm">
                {card.summary}
              </Box>
              <small>
                {card.minutes} minutes · {formatCount(card.steps, "step")} · {formatShort(card.points, "")} points
                {card.work && ` · ${sheetWords(card.work)}`}
              </small>
            </Box>
            {drives && (
              <Button
                size="xs"
                variant="light"
                loading={busy === card.id}
                aria-label={`${card.work ? "Go on with" : "Begin"} ${card.title}`}
                onClick={() => void begin(card.id)}
              >
                {card.work ? "Go on" : "Begin"}
              </Button>
            )}
            {card.own && teaches && (
              <Button size="xs" variant="subtle" aria-label={`Delete ${card.title}`} onClick={() => void remove(card)}>
                Delete
              </Button>
            )}
          </Box>
        ))}
      </Box>
      {teaches && <OpenOwn onOpened={onChanged} />}
    </section>
  );
}

/** A sheet from disk; a mistake in it is shown with its line and field. */
function OpenOwn({ onOpened }: { onOpened(): void }) {
  const [error, setError] = useState("");
  const open = async (file: File | null) => {
    if (!file) return;
    setError("");
    try {
      await sheets.open(await file.text());
      onOpened();
    } catch (refused) {
      const body = refused instanceof ApiError ? refused.body : undefined;
      setError(`${file.name}: ${body ? [body.message, body.hint].filter(Boolean).join(". ") : String(refused)}`);
    }
  };
  return (
    <div>
      <FileButton accept=".md,text/markdown" onChange={open} inputProps={{ "aria-label": "Sheet file" }}>
        {(props) => (
          <Button {...props} size="xs">
            Open a sheet of your own…
          </Button>
        )}
      </FileButton>
      {error && (
        <Box component="p" role="alert" className="wrong" mt={6} style={{ overflowWrap: "anywhere" }}>
          {error}
        </Box>
      )}
    </div>
  );
}
