import { Box } from "@mantine/core";
import { DASHES } from "./palette";

/** A short stroke in a trace's colour and dash. */
export function TraceSwatch({ colour, dash }: { colour: string; dash: number }) {
  return (
    <svg width="22" height="8" aria-hidden="true" style={{ flex: "none" }}>
      <line
        x1="1"
        y1="4"
        x2="21"
        y2="4"
        stroke={colour}
        strokeWidth="2.4"
        strokeDasharray={DASHES[dash].map((d) => d * 0.8).join(" ")}
      />
    </svg>
  );
}

/** A signal's name: its block, then its quantity unless the block is named after it. */
export function SignalName({ name }: { name: string }) {
  const [block, ...rest] = name.split(".").map(words);
  const quantity = rest.join(" ");
  return (
    <span style={{ whiteSpace: "nowrap" }} title={name}>
      <Box component="span" c="dimmed">
        {block}
      </Box>
      {!block.endsWith(quantity) && <span data-rest> {quantity}</span>}
    </span>
  );
}

const words = (text: string): string => text.replaceAll("_", " ");
