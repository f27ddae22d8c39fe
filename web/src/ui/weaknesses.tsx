import { Box } from "@mantine/core";
import type { BlockCard } from "../api/types";
import { Prose } from "./prose";

const BAR = { borderLeft: "2px solid var(--paused)" };

/** The known weaknesses of a block, to be read before the block is trusted. */
export function Weaknesses({ of }: { of: BlockCard | undefined }) {
  return of?.weaknesses.map((weakness) => (
    <Box component="p" key={weakness} role="note" fz="sm" my={6} pl={8} style={BAR}>
      <b>Known weakness</b> <Prose text={weakness} />
    </Box>
  ));
}
