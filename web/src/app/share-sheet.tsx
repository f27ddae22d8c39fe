import { Textarea } from "@mantine/core";
import { useEffect, useRef, useState } from "react";
import { api } from "../api/api";
import { ApiError } from "../api/client";
import { noteOwnLink } from "../bench/open-bench";
import { showError } from "../bench/send";
import { useBench } from "../stream/bench-store";
import { EmptyState } from "../ui/empty-state";
import { formatTick } from "../ui/format";
import styles from "./dialogs.module.css";
import { sharedLayout } from "./layouts";
import { LinkBox } from "./link-box";
import { SideSheet } from "./side-sheet";
import { WatchLinks } from "./watch-links";

const LONGEST_NOTE = 2000;
const WATCHED =
  "People with the access token open this moment. All others watch this bench live, until the time is over.";

/** Share the experiment: a link to this very moment, with how the page looks and a note. */
export function ShareSheet() {
  return (
    <SideSheet name="share" title="Share this experiment" size={440}>
      <Share />
    </SideSheet>
  );
}

interface Made {
  id: string;
  tick: number;
}

function Share() {
  const bench = useBench((s) => s.bench?.id);
  const blind = useBench((s) => s.blind);
  if (!blind) return bench && <MadeLink key={bench} bench={bench} />;
  return (
    <EmptyState title="Answer first">
      A link holds all that was done on this bench, what is hidden too. Give your answer in Lesson › Hidden fault, or
      end the game in Lesson › Games, then share.
    </EmptyState>
  );
}

function MadeLink({ bench }: { bench: string }) {
  const [made, setMade] = useState<Made | undefined>(undefined);
  const [error, setError] = useState<ApiError | undefined>(undefined);
  const [note, setNote] = useState("");
  const [watched, setWatched] = useState("");
  const kept = useRef("");
  const asked = useRef(false);

  useEffect(() => {
    if (asked.current) return;
    asked.current = true; // the link is for the moment of the click
    const layout = sharedLayout();
    api.makeLink({ bench, title: "", note: "", layout: layout ? { ...layout } : null }).then(
      ({ id, tick }) => {
        noteOwnLink(id);
        setMade({ id, tick: tick ?? 0 });
      },
      (refused: unknown) => (refused instanceof ApiError ? setError(refused) : Promise.reject(refused)),
    );
  }, [bench]);

  const keepNote = () => {
    if (!made || note === kept.current) return;
    kept.current = note;
    api.changeLink(made.id, { note }).catch(showError);
  };

  if (error) return <EmptyState title={error.body.message}>{error.body.hint}</EmptyState>;
  if (!made) return <EmptyState title="Making the link">The server stores every command on this bench.</EmptyState>;
  return (
    <>
      <p className={styles.remark}>
        The link opens a new bench at {formatTick(made.tick)} with the same bits, your layout, cursors and note. It does
        not include what you do here afterwards.
      </p>
      <LinkBox path={watched || `?link=${made.id}`} what="Link" remark={watched && WATCHED} onCopy={keepNote} />
      <Textarea
        size="sm"
        label="Note, shown above the bench to people who open the link"
        maxLength={LONGEST_NOTE}
        autosize
        minRows={2}
        value={note}
        onChange={(e) => setNote(e.currentTarget.value)}
        onBlur={keepNote}
      />
      <WatchLinks bench={bench} link={made.id} onLet={(path) => setWatched(path.slice(1))} />
    </>
  );
}
