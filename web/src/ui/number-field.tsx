import { useEffect, useRef, useState } from "react";
import { formatEntry, formatShort } from "./format";
import styles from "./number-field.module.css";
import { roundTo } from "./unit-scale";

interface NumberFieldProps {
  label: string;
  unit: string;
  value: number | undefined;
  minimum: number | null;
  maximum: number | null;
  integer?: boolean;
  disabled?: boolean;
  onCommit(value: number): void;
}

/** A number with its unit: typed in any notation, taken on Enter or on leaving, restored on Escape. */
export function NumberField({
  label,
  unit,
  value,
  minimum,
  maximum,
  integer = false,
  disabled = false,
  onCommit,
}: NumberFieldProps) {
  const shown = value === undefined ? "" : formatEntry(value);
  const [text, setText] = useState(shown);
  const [wrong, setWrong] = useState<string | undefined>(undefined);
  // An entry is its author's from the first key until it is taken or left: a value that comes late does not replace it.
  const typing = useRef(false);
  useEffect(() => {
    if (typing.current) return;
    setText(shown);
    setWrong(undefined);
  }, [shown]);

  const take = (entry: string) => {
    const parsed = entry === shown ? undefined : parseNumber(entry, { minimum, maximum, integer });
    if (typeof parsed === "string") return setWrong(parsed);
    typing.current = false;
    setWrong(undefined);
    if (parsed !== undefined) onCommit(parsed);
  };
  const leave = () => {
    if (!typing.current) return; // taken already
    take(text);
    typing.current = false;
  };

  return (
    <span className={styles.field} data-wrong={wrong !== undefined} title={wrong}>
      <input
        aria-label={unit ? `${label}, ${unit}` : label}
        aria-invalid={wrong !== undefined}
        inputMode="decimal"
        placeholder="auto"
        value={text}
        disabled={disabled}
        onChange={(event) => {
          typing.current = true;
          setText(event.currentTarget.value);
        }}
        onBlur={leave}
        onKeyDown={(event) => {
          if (event.key === "Enter") take(text);
          if (event.key === "Escape") {
            typing.current = false;
            setText(shown);
            setWrong(undefined);
          }
          if ((event.key === "ArrowUp" || event.key === "ArrowDown") && value !== undefined) {
            event.preventDefault();
            const next = formatEntry(nudge(Number(text), event.key === "ArrowUp" ? 1 : -1, integer));
            setText(next);
            take(next);
          }
        }}
      />
      {unit && (
        <span className="remark" style={{ marginLeft: 5 }}>
          {unit}
        </span>
      )}
      {wrong && (
        <span role="alert" className={styles.wrong}>
          {wrong}
        </span>
      )}
    </span>
  );
}

interface Limits {
  minimum: number | null;
  maximum: number | null;
  integer: boolean;
}

/** A typed number, or its error in words. */
export function parseNumber(text: string, { minimum, maximum, integer }: Limits): number | string {
  const value = Number(text.trim().replace(",", ".").replace("−", "-"));
  if (text.trim() === "" || !Number.isFinite(value)) return "not a number";
  if (integer && !Number.isInteger(value)) return "whole numbers only";
  if (minimum !== null && value < minimum) return `at least ${formatShort(minimum, "", 6)}`;
  if (maximum !== null && value > maximum) return `at most ${formatShort(maximum, "", 6)}`;
  return value;
}

/** The next value up or down: one unit of the second digit. */
export function nudge(value: number, direction: 1 | -1, integer: boolean): number {
  if (!Number.isFinite(value)) return value;
  const power = value === 0 ? 0.1 : 10 ** (Math.floor(Math.log10(Math.abs(value))) - 1);
  const step = integer ? Math.max(1, Math.round(power)) : power;
  return roundTo(value + direction * step, 8);
}
