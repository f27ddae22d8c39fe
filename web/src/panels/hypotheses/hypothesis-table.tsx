import { ActionIcon, ColorSwatch, Group } from "@mantine/core";
import { IconX } from "@tabler/icons-react";
import { NumberField } from "../../ui/number-field";
import { TableHead } from "../../ui/table-head";
import { hypothesisStyle, traceColour } from "../../ui/trace-style";
import { roundTo } from "../../ui/unit-scale";
import { useScheme } from "../../ui/use-canvas";
import { FACTORS, type Hypothesis, LEAST, withFactor } from "./draft";
import styles from "./hypotheses.module.css";

/** The list as it can be edited: each factor in percent beside nominal. */
export function HypothesisTable({ list, onChange }: { list: Hypothesis[]; onChange(list: Hypothesis[]): void }) {
  const scheme = useScheme();
  const put = (index: number, next: Hypothesis) => onChange(list.map((h, i) => (i === index ? next : h)));
  return (
    <div style={{ overflowX: "auto" }}>
      <table className={styles.table}>
        <TableHead names={["Hypothesis", ...FACTORS, ""]} />
        <tbody>
          {list.map((hypothesis, i) => (
            // biome-ignore lint/suspicious/noArrayIndexKey: a hypothesis is known by its place, its name can change
            <tr key={i}>
              <th scope="row">
                <Group gap={8} wrap="nowrap" className={styles.name}>
                  <ColorSwatch
                    size={10}
                    radius={2}
                    withShadow={false}
                    color={traceColour(hypothesisStyle(i), scheme)}
                  />
                  <input
                    aria-label={`Name of hypothesis ${i + 1}`}
                    value={hypothesis.name}
                    maxLength={24}
                    spellCheck={false}
                    onChange={(e) => put(i, { ...hypothesis, name: e.currentTarget.value })}
                  />
                </Group>
              </th>
              {FACTORS.map((factor) => (
                <td key={factor}>
                  <NumberField
                    label={`${factor} of ${hypothesis.name}`}
                    unit="%"
                    value={roundTo(((hypothesis[factor] ?? 1) - 1) * 100, 6)}
                    minimum={-99}
                    maximum={9900}
                    onCommit={(percent) => put(i, withFactor(hypothesis, factor, percent))}
                  />
                </td>
              ))}
              <td>
                <ActionIcon
                  size={26}
                  disabled={list.length <= LEAST}
                  aria-label={`Leave out ${hypothesis.name}`}
                  onClick={() => onChange(list.filter((_, j) => j !== i))}
                >
                  <IconX size={14} />
                </ActionIcon>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}
