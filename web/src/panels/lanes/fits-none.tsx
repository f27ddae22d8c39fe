import { Tooltip } from "@mantine/core";
import { formatNumber } from "../../ui/format";
import styles from "./lanes.module.css";

/** The bank itself knows from its residuals that what it names is not so. */
export function FitsNone({ least }: { least: number }) {
  const times = formatNumber(Math.sqrt(least), 1);
  return (
    <Tooltip
      multiline
      w={280}
      label={`Even the hypothesis that fits best misses by ${times} times what its filter expects. Something acts that is not in the list, or the assumed noise is too small.`}
    >
      <b className={styles.none}>fits none</b>
    </Tooltip>
  );
}
