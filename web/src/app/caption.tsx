import { CloseButton } from "@mantine/core";
import { showSentence, toggleNarrator, useNarrator } from "../bench/narrator";
import { useView } from "../bench/view-store";
import { useBench } from "../stream/bench-store";
import styles from "./caption.module.css";
import { moreText, useCaption } from "./use-caption";

/** The line under the panels of a lecture or a replay: the newest sentence of the narrator. A click shows its place. */
export function Caption() {
  const on = useNarrator((s) => s.on);
  const isWanted = useView((s) => s.layout === "lecture" || s.large);
  const replay = useBench((s) => Boolean(s.bench?.replay_of));
  const caption = useCaption();
  const diagnosed = useBench((s) => Object.keys(s.bench?.diagnosers ?? {}).length > 0);
  if (!on || !(isWanted || replay)) return null;
  return (
    // spoken by the page's live region, not here a second time
    <section className={styles.caption} aria-label="What happens now" data-kind={caption?.sentence.kind}>
      {caption ? (
        <button type="button" title="Show it on the scopes" onClick={() => showSentence(caption.sentence)}>
          {caption.more > 0 && <small>{moreText(caption.more)} </small>}
          {caption.sentence.text}
        </button>
      ) : (
        <p>{diagnosed ? LANES : "Faults, switches and trips are told here."}</p>
      )}
      <CloseButton size="sm" aria-label="Turn the narrator off (Q)" onClick={toggleNarrator} />
    </section>
  );
}

const LANES =
  "Each lane of Diagnosis is one guess at the device, as a model. The fuller a lane, the more the guess is believed. Faults, switches and verdicts are told here.";
