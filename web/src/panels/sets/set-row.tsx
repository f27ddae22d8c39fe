import { ActionIcon, Button, TextInput } from "@mantine/core";
import { IconPencil, IconTrash } from "@tabler/icons-react";
import { useState } from "react";
import { api } from "../../api/api";
import { useMay } from "../../api/me";
import type { ParameterSet } from "../../api/types";
import { announce } from "../../bench/announce";
import { send, showError, showing } from "../../bench/send";
import { tellUndoable } from "../../bench/tell";
import { formatCount } from "../../ui/format";
import rows from "../../ui/row-list.module.css";

interface SetRowProps {
  set: ParameterSet;
  bench: string;
  onCompare(): void;
  onChanged(): void;
}

/** One set: put it on the bench, compare it, name it anew, delete it. */
export function SetRow({ set, bench, onCompare, onChanged }: SetRowProps) {
  const [name, setName] = useState<string | undefined>(undefined);
  const teaches = useMay("teach");
  const apply = showing(async () => {
    const { result, left_out } = await api.applyParameterSet(bench, set.id);
    const rest = left_out.length > 0 ? `; ${formatCount(left_out.length, "value")} of it are not on this bench` : "";
    if (!result) announce(`The bench has the values of ${set.name} already${rest}.`);
    const said = result ? `${set.name} is on the bench${rest}` : `The bench has these values already${rest}`;
    tellUndoable(said, result ? () => send({ kind: "undo" }, `Undone: ${set.name}`) : undefined);
  });
  const rename = async () => {
    const next = name?.trim();
    setName(undefined);
    if (!next || next === set.name) return;
    await api.renameParameterSet(set.id, next).then(onChanged, showError);
  };
  const remove = () => {
    if (window.confirm(`Delete the set ${set.name} for good?`))
      void api.removeParameterSet(set.id).then(onChanged, showError);
  };
  return (
    <li className={rows.row}>
      {name === undefined ? (
        <div className={rows.what}>
          <b>{set.name}</b>
          <span>
            from {set.scenario}, {new Date(set.created).toLocaleString([], { dateStyle: "short", timeStyle: "short" })}
          </span>
        </div>
      ) : (
        <TextInput
          className={rows.what}
          aria-label={`New name of ${set.name}`}
          autoFocus
          maxLength={100}
          value={name}
          onChange={(e) => setName(e.currentTarget.value)}
          onBlur={rename}
          onKeyDown={(e) => e.key === "Enter" && rename()}
        />
      )}
      <div className={`row ${rows.do}`}>
        <Button variant="filled" size="compact-xs" onClick={apply} aria-label={`Put ${set.name} on the bench`}>
          Put on the bench
        </Button>
        <Button size="compact-xs" onClick={onCompare} aria-label={`Compare ${set.name}`}>
          Compare
        </Button>
        {teaches && (
          <>
            <ActionIcon size={24} aria-label={`Rename ${set.name}`} onClick={() => setName(set.name)}>
              <IconPencil size={14} />
            </ActionIcon>
            <ActionIcon size={24} aria-label={`Delete ${set.name}`} onClick={remove}>
              <IconTrash size={14} />
            </ActionIcon>
          </>
        )}
      </div>
    </li>
  );
}
