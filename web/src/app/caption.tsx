import { showSentence, useNarrator } from "../bench/narrator";
import { useBench } from "../stream/bench-store";
import styles from "./strip.module.css";
import { moreText, useCaption } from "./use-caption";

const EVENTS = "Events are described here as they happen.";
const LANES = "Each lane of Diagnosis is one guess at the device. A full lane means it is certain.";

/** The newest sentence of the narrator, and before the first one the bench in a sentence. A click shows its place. */
export function Caption({ intro }: { intro?: string }) {
  const on = useNarrator((s) => s.on);
  const caption = useCaption();
  const diagnosed = useBench((s) => Object.keys(s.bench?.diagnosers ?? {}).length > 0);
  if (!on) return null;
  return (
    // spoken by the page's live region, not here a second time
    <section className={styles.caption} aria-label="What happens now" data-kind={caption?.sentence.kind}>
      {caption ? (
        <button type="button" title="Show it on the scopes" onClick={() => showSentence(caption.sentence)}>
          {caption.more > 0 && <small>{moreText(caption.more)} </small>}
          {caption.sentence.text}
        </button>
      ) : (
        <p>{intro ?? (diagnosed ? LANES : EVENTS)}</p>
      )}
    </section>
  );
}
