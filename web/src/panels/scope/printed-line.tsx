import { Checkbox, Group, Text } from "@mantine/core";
import type { PrintedMark } from "../../api/types";
import { placeIn, showPrinted, usePrinted } from "../../bench/printed";

/** The printed marks of the signals of a scope in words, and the switch that hides them. */
export function PrintedLine({ marks }: { marks: PrintedMark[] }) {
  const isShown = usePrinted((s) => s.isShown);
  const said = [...new Set(marks.map((mark) => `“${mark.words}” (${placeIn(mark)})`))];
  return (
    <Group gap={10} wrap="nowrap" flex="none" mih="var(--target)" p="0 12px 4px" c="dimmed" fz="sm">
      <Checkbox label="Printed" checked={isShown} onChange={(event) => showPrinted(event.currentTarget.checked)} />
      {isShown && (
        <Text inherit truncate title={said.join("\n")}>
          {said.join("; ")}
        </Text>
      )}
    </Group>
  );
}
