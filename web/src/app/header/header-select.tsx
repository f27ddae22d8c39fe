import { Select } from "@mantine/core";
import { type CSSProperties, useRef } from "react";
import { useMay, useServed } from "../../api/me";
import { WATCHING } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import { useBoardState } from "../../stream/freshness";
import { Prose } from "../../ui/prose";
import styles from "./header.module.css";

interface Choice {
  value: string;
  title: string;
  /** A line of words about it. */
  about: string;
  /** Heading above it and those like it. */
  group?: string;
}

interface HeaderSelectProps {
  label: string;
  value: string | undefined;
  choices: readonly Choice[];
  /** Why nothing else can be chosen now. */
  locked: string | undefined;
  onChoose(value: string): void;
}

/** A part of the bench by name, and the others in its place, each with a line of words. */
export function HeaderSelect({ label, value, choices, locked, onChoose }: HeaderSelectProps) {
  const input = useRef<HTMLInputElement>(null);
  const groups = [...new Set(choices.map(({ group = "" }) => group))];
  const itemsOf = (shared: string) =>
    choices.filter(({ group = "" }) => group === shared).map(({ value, title }) => ({ value, label: title }));
  const shown = choices.find((choice) => choice.value === value);
  return (
    <Select
      ref={input}
      className={styles.choice}
      style={{ "--letters": Math.max((shown?.title.length ?? 8) + 6, label.length) } as CSSProperties}
      label={label}
      labelProps={{ className: "cut", display: "block", c: "dimmed", fz: "xs", fw: 450, lh: 1.2 }}
      title={locked ?? shown?.title}
      allowDeselect={false}
      value={value ?? null}
      placeholder="Loading" // the choices come from the server
      nothingFoundMessage="The list is on its way."
      disabled={locked !== undefined}
      data={groups.length > 1 ? groups.map((group) => ({ group, items: itemsOf(group) })) : itemsOf(groups[0])}
      renderOption={({ option }) => <Words choice={choices.find((one) => one.value === option.value)} />}
      onChange={(name) => name && name !== value && onChoose(name)}
      onOptionSubmit={() => input.current?.blur()} // else the list keeps the page's keys
      maxDropdownHeight={420}
      comboboxProps={{ shadow: "md", width: 340, position: "bottom-start" }}
    />
  );
}

function Words({ choice }: { choice: Choice | undefined }) {
  return (
    choice && (
      <span>
        {choice.title}
        <small>
          <Prose text={choice.about} />
        </small>
      </span>
    )
  );
}

/** Why a person cannot change the bench from the header; nothing where they can. */
export function useLocked(): string | undefined {
  const replay = useBench((s) => Boolean(s.bench?.replay_of));
  const record = useBench((s) => Boolean(s.bench?.record));
  const unknown = useBoardState() === undefined;
  const drives = useMay("drive");
  if (replay) return "A recording plays. The past cannot be changed.";
  if (record) return "A record plays. It was measured, and nothing can act on it.";
  if (!drives) return WATCHING;
  return unknown ? "The page is not connected to the bench." : undefined;
}

/** The same for what would help to find a hidden fault. */
export function useLockedWhileHidden(): string | undefined {
  const isHidden = useBench((s) => Boolean(s.blind));
  const served = useServed();
  const locked = useLocked();
  if (!served) return "This page has no server, so its device and its sensor stay as they are.";
  return locked ?? (isHidden ? "A fault is hidden on this bench. Answer first." : undefined);
}
