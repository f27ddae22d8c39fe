import { ActionIcon, Box, NativeSelect, Switch, Tooltip } from "@mantine/core";
import { IconArrowBackUp, IconLock } from "@tabler/icons-react";
import { useServed } from "../../api/me";
import type { Parameter } from "../../api/types";
import { formatShort } from "../../ui/format";
import { NumberField } from "../../ui/number-field";
import { unitText } from "../../ui/unit-scale";
import styles from "./card.module.css";
import { parameterTitle } from "./parameter-title";

const FIXED = "Fixed while the bench exists: it changes the wiring. Start a new bench to choose it.";
const FIXED_HERE = "Fixed: a change of it needs the server.";

interface ParameterRowProps {
  parameter: Parameter;
  value: unknown;
  staged: boolean;
  onChange(value: unknown): void;
}

/** One parameter: its meaning, its value with unit, its default and limits, and whether it may change now. */
export function ParameterRow({ parameter, value, staged, onChange }: ParameterRowProps) {
  const { meaning, live, type } = parameter;
  const served = useServed();
  const label = parameterTitle(parameter);
  const isDefault = JSON.stringify(value) === JSON.stringify(parameter.default);
  const range = limits(parameter);
  return (
    <div className={styles.parameter} data-staged={staged}>
      <Box className="column" flex="1 1 110px" miw={0}>
        <Box component="span" className="line" fz="sm" fw={560}>
          {label}
          {!live && (
            <Tooltip label={served ? FIXED : FIXED_HERE}>
              <IconLock size={12} role="img" aria-label="fixed while running" />
            </Tooltip>
          )}
        </Box>
        <span className="remark">
          {meaning}
          {range && ` (${range})`}
        </span>
      </Box>
      <Box className="line" flex="none">
        {!isDefault && live && parameter.default !== null && type !== "list" && (
          <Tooltip
            label={`Back to the default ${typeof parameter.default === "number" ? formatShort(parameter.default, parameter.unit, 6) : String(parameter.default).replaceAll("_", " ")}`}
          >
            <ActionIcon
              size={22}
              aria-label={`${label}: back to the default`}
              onClick={() => onChange(parameter.default)}
            >
              <IconArrowBackUp size={14} />
            </ActionIcon>
          </Tooltip>
        )}
        {type === "boolean" ? (
          <Switch
            aria-label={label}
            checked={value === true}
            disabled={!live}
            onChange={(e) => onChange(e.currentTarget.checked)}
          />
        ) : type === "choice" ? (
          <NativeSelect
            w={132}
            aria-label={label}
            disabled={!live}
            value={String(value)}
            data={(parameter.choices ?? []).map((choice) => ({ value: choice, label: choice.replaceAll("_", " ") }))}
            onChange={(e) => onChange(e.currentTarget.value)}
          />
        ) : typeof value === "number" || value === null || value === undefined ? (
          <NumberField
            label={label}
            unit={unitText(parameter.unit)}
            value={typeof value === "number" ? value : undefined}
            minimum={parameter.minimum}
            maximum={parameter.maximum}
            integer={type === "integer"}
            disabled={!live}
            onCommit={onChange}
          />
        ) : (
          <code>{String(value)}</code>
        )}
      </Box>
    </div>
  );
}

function limits({ minimum, maximum, unit }: Parameter): string {
  const say = (bound: number) => formatShort(bound, unit, 6);
  if (minimum !== null && maximum !== null) return `${say(minimum)} to ${say(maximum)}`;
  if (minimum !== null) return `at least ${say(minimum)}`;
  return maximum === null ? "" : `at most ${say(maximum)}`;
}
