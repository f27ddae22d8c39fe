import { useEffect, useState } from "react";
import { formatEntry } from "./format";
import styles from "./number-field.module.css";
import { nudge, parseNumber } from "./parse-number";

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
  useEffect(() => {
    setText(shown);
    setWrong(undefined);
  }, [shown]);

  const take = (entry: string) => {
    if (entry === shown) return;
    const parsed = parseNumber(entry, { minimum, maximum, integer });
    if (typeof parsed === "string") return setWrong(parsed);
    setWrong(undefined);
    onCommit(parsed);
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
        onChange={(event) => setText(event.currentTarget.value)}
        onBlur={() => take(text)}
        onKeyDown={(event) => {
          if (event.key === "Enter") take(text);
          if (event.key === "Escape") {
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
      {unit && <span className={styles.unit}>{unit}</span>}
      {wrong && (
        <span role="alert" className={styles.wrong}>
          {wrong}
        </span>
      )}
    </span>
  );
}
