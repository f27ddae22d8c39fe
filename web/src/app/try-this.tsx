import { Box, Button, CloseButton, Group } from "@mantine/core";
import { IconPlayerPlayFilled, IconSquare, IconSquareCheckFilled } from "@tabler/icons-react";
import { useMay, useServed } from "../api/me";
import { showPanel } from "../bench/dock";
import { useBusy } from "../bench/use-busy";
import { startBeside } from "./first-bench";
import type { Hints } from "./hints";
import rest from "./rest.module.css";
import styles from "./strip.module.css";
import { tourSeen } from "./tours/run-tour";
import { OfferTour } from "./tours/tour-list";
import type { TickedHints } from "./use-hints";

/** The next thing to try on the bench. */
export function TryThis({ tips }: { tips: TickedHints }) {
  const { hints, done } = tips;
  const served = useServed();
  const at = hints.findIndex(({ id }) => !done.has(id));
  return (
    <section className={`line ${styles.lead}`} aria-label="Try this">
      <p className={styles.words}>
        <strong>
          {at < 0 ? "All tried." : `Try this${hints.length > 1 ? ` (${at + 1} of ${hints.length})` : ""}:`}
        </strong>{" "}
        {hints[at]?.text}
      </p>
      {served && <Guided {...tips.guided} />}
      <CloseButton size="sm" aria-label="Dismiss the hints" onClick={tips.dismiss} />
    </section>
  );
}

/** The bench in a sentence, all that can be tried on it, and what there is beside. */
export function HintList({ tips }: { tips: TickedHints }) {
  const teaches = useMay("teach");
  const served = useServed();
  return (
    <section aria-label="Things to try">
      <Box component="p" mb={6}>
        {tips.intro} {tips.more}
      </Box>
      <ul className={rest.hints}>
        {tips.hints.map(({ id, text }) => (
          <Group component="li" key={id} gap={6} wrap="nowrap" data-done={tips.done.has(id)}>
            {tips.done.has(id) ? <IconSquareCheckFilled size={16} /> : <IconSquare size={16} />}
            {text}
            {tips.done.has(id) && <span className="visually-hidden">, done</span>}
          </Group>
        ))}
      </ul>
      <Group gap={6} mt={8}>
        {teaches && !tourSeen() && <OfferTour />}
        {served && tips.canHide && <Button onClick={() => showPanel("blind", "faults")}>Find a hidden fault</Button>}
      </Group>
    </section>
  );
}

/** A scenario that shows by itself what there is to see. */
function Guided({ scenario, label }: Hints["guided"]) {
  const [busy, during] = useBusy();
  const start = () => {
    void during(() => startBeside(scenario));
  };
  return (
    <Button variant="filled" loading={busy} leftSection={<IconPlayerPlayFilled size={14} />} onClick={start}>
      {label}
    </Button>
  );
}
