import { Box, Group } from "@mantine/core";
import type { ReactNode } from "react";

/** The width of a list in a group: it leaves room for the buttons. */
export const CHOICE = { flex: "1 1 150px", miw: 0, maw: 280 };

/** A kind of change that the teacher makes on many benches: its name, and its fields and buttons. */
export function GroupForAll({ name, label, children }: { name: string; label: string; children: ReactNode }) {
  return (
    <Group component="fieldset" gap={4} aria-label={label}>
      <Box component="span" className="note" flex="none" w="11ch">
        {name}
      </Box>
      {children}
    </Group>
  );
}
