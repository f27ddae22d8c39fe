import { Box, Tooltip } from "@mantine/core";
import { type RefObject, useEffect } from "react";
import { stream } from "../../stream/stream";
import { formatCount, formatShort } from "../../ui/format";
import { useChanged } from "../../ui/use-changed";
import type { Banded } from "./envelope-rule";
import type { PlotTrace } from "./paint-scope";
import type { ScopePlot } from "./scope-plot";

const EVERY_MS = 300;

interface EnvelopeNoteProps {
  traces: PlotTrace[];
  plot: RefObject<ScopePlot | undefined>;
}

/** Says that a filled band is the envelope of a tone too fast for the window and not a signal. */
export function EnvelopeNote({ traces, plot }: EnvelopeNoteProps) {
  const [bands, setBands] = useChanged<Banded | undefined>(undefined);
  useEffect(() => {
    let last = 0;
    return stream.loop.add(() => {
      const now = performance.now();
      if (now - last < EVERY_MS) return;
      last = now;
      setBands(plot.current?.bands());
    });
  }, [plot, setBands]);
  if (!bands) return null;
  const names = bands.traces.flatMap((i) => traces[i]?.name.replaceAll(/[._]/g, " ") ?? []).join(", ");
  const label =
    `Each pixel takes ${formatShort(bands.perPixelMs, "ms", 3)}, ${formatCount(Math.round(bands.samples), "sample")}. ` +
    `The band reaches from the least to the largest value in it: ${names}. A shorter window shows the signal.`;
  return (
    <Tooltip label={label} multiline w={280}>
      <Box
        pos="absolute"
        top={2}
        right={12}
        p="0 6px"
        lh="18px"
        bdrs={4}
        bg="var(--hover)"
        className="remark"
        role="note"
        aria-label={`envelope: ${label}`}
        tabIndex={0}
      >
        envelope
      </Box>
    </Tooltip>
  );
}
