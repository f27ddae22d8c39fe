import { Button, Menu } from "@mantine/core";
import { api } from "../../api/api";
import { useAnswer } from "../../api/queries";
import type { Recording } from "../../api/types";
import { useBench } from "../../stream/bench-store";
import { formatMoment, formatSi } from "../../ui/format";
import styles from "./sheet.module.css";

/** The menu lists this many recordings, the newest. */
const MOST = 12;

const isWhole = ({ state, ticks }: Recording) => state !== "armed" && state !== "recording" && ticks > 0;
const wordsOf = ({ name, ticks, dt_ms, start_tick }: Recording) =>
  `${name}, ${formatSi(ticks * dt_ms, "ms")} from ${formatMoment(start_tick * dt_ms)}`;

interface HandedInProps {
  /** Ids of the recordings handed in. */
  ids: readonly string[];
  onAdd(recording: string): void;
}

/** The recordings that are handed in with a sheet, and a menu to add one; none is served while a fault is hidden. */
export function HandedIn({ ids, onAdd }: HandedInProps) {
  const blind = useBench((s) => s.bench?.blind) ?? undefined;
  const { value, again } = useAnswer(blind ? undefined : ["recordings"], api.recordings);
  const recordings = value ?? [];
  const left = recordings.filter((one) => isWhole(one) && !ids.includes(one.id)).slice(0, MOST);
  return (
    <>
      {!blind && (
        <Menu position="bottom-start" onOpen={again}>
          <Menu.Target>
            <Button>Add a recording…</Button>
          </Menu.Target>
          <Menu.Dropdown>
            {left.length > 0 ? (
              <Menu.Label>It is handed in with the sheet</Menu.Label>
            ) : (
              <Menu.Item disabled>There is no other recording: V on the bench begins and ends one</Menu.Item>
            )}
            {left.map((one) => (
              <Menu.Item key={one.id} onClick={() => onAdd(one.id)}>
                {wordsOf(one)}
              </Menu.Item>
            ))}
          </Menu.Dropdown>
        </Menu>
      )}
      {ids.length > 0 && (
        <ul className={styles.recordings} aria-label="Recordings handed in">
          {ids.map((id) => {
            const known = recordings.find((one) => one.id === id);
            return <li key={id}>Handed in: {known ? wordsOf(known) : `recording ${id.slice(0, 8)}`}</li>;
          })}
        </ul>
      )}
    </>
  );
}
