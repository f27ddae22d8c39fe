import { ActionIcon, Autocomplete, Box, Button, Stack, TextInput } from "@mantine/core";
import { IconPlus, IconX } from "@tabler/icons-react";
import type { ReactNode } from "react";
import { EMPTY_ROW, pathTitle, type Row } from "./draft";
import styles from "./runs.module.css";

interface ValueRowsProps {
  label: string;
  /** The words of the button that adds a row. */
  more: string;
  placeholder: string;
  rows: Row[];
  paths: string[];
  onChange(rows: Row[]): void;
}

/** Values at dotted paths of the scenario, one below the other. */
export function ValueRows({ label, more, placeholder, rows, paths, onChange }: ValueRowsProps) {
  return (
    <PathRows
      label={label}
      more={more}
      rows={rows}
      paths={paths}
      empty={EMPTY_ROW}
      onChange={onChange}
      entry={(row, change, name) => (
        <TextInput
          aria-label={`${name}: value`}
          placeholder={placeholder}
          value={row.text}
          onChange={(e) => change({ ...row, text: e.currentTarget.value })}
        />
      )}
    />
  );
}

interface PathRowsProps<T extends { path: string }> {
  label: string;
  more: string;
  rows: T[];
  paths: string[];
  empty: T;
  onChange(rows: T[]): void;
  entry(row: T, change: (row: T) => void, name: string): ReactNode;
}

/** Rows that begin with a path of the scenario. */
export function PathRows<T extends { path: string }>(props: PathRowsProps<T>) {
  const { label, more, rows, paths, empty, onChange, entry } = props;
  const change = (at: number, row: T) => onChange(rows.map((old, i) => (i === at ? row : old)));
  return (
    <Stack component="fieldset" gap={4} align="flex-start">
      <Box component="legend" pb={4} fz="xs" fw={500}>
        {label}
      </Box>
      {rows.map((row, at) => {
        const name = row.path || `${label} ${at + 1}`;
        return (
          // biome-ignore lint/suspicious/noArrayIndexKey: a row is its place
          <div key={at} className={styles.row}>
            <Autocomplete
              aria-label={`${label} ${at + 1}: path`}
              placeholder="sensor.noise_um"
              data={paths}
              limit={12}
              comboboxProps={{ width: 280, position: "bottom-start" }}
              renderOption={({ option }) => (
                <span>
                  {option.value}
                  <Box component="small" display="block">
                    {pathTitle(option.value)}
                  </Box>
                </span>
              )}
              value={row.path}
              onChange={(path) => change(at, { ...row, path })}
            />
            {entry(row, (next) => change(at, next), name)}
            <ActionIcon
              size={24}
              aria-label={`Remove ${name}`}
              onClick={() => onChange(rows.filter((_, i) => i !== at))}
            >
              <IconX size={14} />
            </ActionIcon>
          </div>
        );
      })}
      <Button
        size="compact-xs"
        variant="subtle"
        leftSection={<IconPlus size={13} />}
        onClick={() => onChange([...rows, empty])}
      >
        {more}
      </Button>
    </Stack>
  );
}
