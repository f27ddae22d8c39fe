import { ActionIcon, Box, Button, Group, TextInput } from "@mantine/core";
import { IconPencil, IconTrash } from "@tabler/icons-react";
import { useCallback, useEffect, useState } from "react";
import { api } from "../api/api";
import { useMay } from "../api/me";
import type { Link } from "../api/types";
import { ownLinks } from "../bench/open-bench";
import { showError } from "../bench/send";
import { useBusy } from "../bench/use-busy";
import { setPage, useView } from "../bench/view-store";
import { EmptyState } from "../ui/empty-state";
import { formatTick } from "../ui/format";
import styles from "./dialogs.module.css";
import { openLink } from "./first-bench";
import { OpenScenario } from "./open-scenario";
import { SideSheet } from "./side-sheet";

/** Scenarios from disk, and the experiments kept on the server: the user's own first. */
export function MineSheet() {
  const teaches = useMay("teach");
  return (
    <SideSheet name="mine" title={teaches ? "Mine" : "From disk"} size={520}>
      {teaches ? <Kept /> : <OpenScenario />}
    </SideSheet>
  );
}

function Kept() {
  const [links, setLinks] = useState<Link[] | undefined>(undefined);
  const load = useCallback(() => void api.links("experiment").then(setLinks, showError), []);
  useEffect(load, [load]);
  const own = new Set(ownLinks());
  const here = links?.filter((link) => own.has(link.id)) ?? [];
  const others = links?.filter((link) => !own.has(link.id)) ?? [];
  return (
    <>
      <OpenScenario onKept={load} />
      <h3 className={styles.heading}>Made in this browser</h3>
      {here.length > 0 ? (
        <ul className={styles.gallery} aria-label="Made in this browser">
          {here.map((link) => (
            <Row key={link.id} link={link} isOwn onChanged={load} />
          ))}
        </ul>
      ) : (
        <EmptyState title="Nothing kept yet">
          Scenarios that you open from disk and experiments that you share are listed here.
        </EmptyState>
      )}
      {others.length > 0 && (
        <>
          <h3 className={styles.heading}>By others on this server</h3>
          <ul className={styles.gallery} aria-label="By others on this server">
            {others.map((link) => (
              <Row key={link.id} link={link} onChanged={load} />
            ))}
          </ul>
        </>
      )}
    </>
  );
}

/** A kept experiment and its buttons; only its author can rename and delete it here. */
function Row({ link, isOwn = false, onChanged }: { link: Link; isOwn?: boolean; onChanged(): void }) {
  const [title, setTitle] = useState<string | undefined>(undefined);
  const [busy, during] = useBusy();
  const open = () =>
    during(async () => {
      await openLink(link.id);
      setPage("bench");
      useView.setState({ dialog: "none" });
    });
  const rename = async () => {
    const next = title?.trim();
    setTitle(undefined);
    if (next && next !== link.title) await api.changeLink(link.id, { title: next }).then(onChanged, showError);
  };
  return (
    <li>
      <Box flex={1} miw={0}>
        {title === undefined ? (
          <h3>{link.title}</h3>
        ) : (
          <form
            onSubmit={(event) => {
              event.preventDefault();
              void rename();
            }}
          >
            <TextInput
              aria-label={`New title of ${link.title}`}
              value={title}
              maxLength={200}
              autoFocus
              onChange={(e) => setTitle(e.currentTarget.value)}
              onBlur={rename}
            />
          </form>
        )}
        {link.note && <p className="note">{link.note}</p>}
        <small>
          {link.tick ? `done up to ${formatTick(link.tick)}` : "from its beginning"} ·{" "}
          {new Date(link.created).toLocaleString([], { dateStyle: "short", timeStyle: "short" })}
        </small>
      </Box>
      <Group flex="none" gap={4} wrap="nowrap">
        <Button size="xs" variant="light" loading={busy} onClick={open} aria-label={`Open ${link.title}`}>
          Open
        </Button>
        {isOwn && (
          <>
            <ActionIcon aria-label={`Rename ${link.title}`} onClick={() => setTitle(link.title)}>
              <IconPencil size={16} />
            </ActionIcon>
            <ActionIcon
              aria-label={`Delete ${link.title}`}
              onClick={() =>
                window.confirm(`Delete ${link.title} for good? Its link will no longer open.`) &&
                api.removeLink(link.id).then(onChanged, showError)
              }
            >
              <IconTrash size={16} />
            </ActionIcon>
          </>
        )}
      </Group>
    </li>
  );
}
