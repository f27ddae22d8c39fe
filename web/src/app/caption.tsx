import { Button } from "@mantine/core";
import { useLayoutEffect, useRef, useState } from "react";
import { useServed } from "../api/me";
import { showSentence, useNarrator } from "../bench/narrator";
import { useBench } from "../stream/bench-store";
import styles from "./strip.module.css";
import { moreText, useCaption } from "./use-caption";

const EVENTS = "Events are described here as they happen.";
/** Says which parts are absent where the bench comes from a folder. */
const UNSERVED =
  "This page computes the bench itself. The narrator, Why, other devices and scenarios, 3D, recordings, classes and campaigns need the server.";
const LANES = "Each lane of Diagnosis is one guess at the device. A full lane means it is certain.";
/** Lines of the row under the panels. */
const LINES = 2;

/** The newest event in the words of the narrator, and before the first one the bench in a sentence. A click shows its place. */
export function Caption({ intro }: { intro?: string }) {
  const on = useNarrator((s) => s.on);
  const served = useServed();
  const caption = useCaption();
  const diagnosed = useBench((s) => Object.keys(s.bench?.diagnosers ?? {}).length > 0);
  if (!on && served) return null;
  const sentence = caption?.sentence;
  const text = served ? (sentence?.text ?? intro ?? (diagnosed ? LANES : EVENTS)) : UNSERVED;
  return (
    // spoken by the page's live region, not here a second time
    <section className={styles.caption} aria-label="What happens now" data-kind={sentence?.kind}>
      <Sentences
        key={text}
        text={text}
        before={caption && caption.more > 0 ? `${moreText(caption.more)} ` : ""}
        onClick={sentence && (() => showSentence(sentence))}
      />
    </section>
  );
}

/** The sentences of a text; a number with a point is no end. */
const sentencesOf = (text: string) => text.split(/(?<=[.!?]) +(?=\p{Lu})/u);

interface SentencesProps {
  text: string;
  before: string;
  onClick?(): void;
}

/** The first sentence of a text, whole; the count before it and the next ones where two lines hold them. A button opens the others. */
function Sentences({ text, before, onClick }: SentencesProps) {
  const box = useRef<HTMLDivElement>(null);
  const [fits, setFits] = useState(Number.POSITIVE_INFINITY);
  const [opened, setOpened] = useState(false);
  const sentences = sentencesOf(text);
  useLayoutEffect(() => {
    const place = box.current;
    if (!place) return;
    const spans = [...place.getElementsByTagName("span")];
    const [count] = place.getElementsByTagName("small");
    const measure = () => {
      for (const part of [...spans, ...(count ? [count] : [])]) part.hidden = false;
      const room = place.getBoundingClientRect().top + LINES * Number.parseFloat(getComputedStyle(place).lineHeight);
      const isBeyond = (span: Element) => span.getBoundingClientRect().bottom > room + 1;
      if (count) count.hidden = isBeyond(spans[0]);
      const beyond = spans.findIndex((span, i) => i > 0 && isBeyond(span));
      spans.forEach((span, i) => {
        span.hidden = beyond > 0 && i >= beyond && !opened;
      });
      setFits(beyond > 0 ? beyond : spans.length);
    };
    measure();
    const observer = new ResizeObserver(measure);
    observer.observe(place);
    return () => observer.disconnect();
  }, [opened]);
  const words = (
    <>
      {before && <small>{before}</small>}
      {sentences.map((one, i) => (
        // biome-ignore lint/suspicious/noArrayIndexKey: a sentence is its place
        <span key={i}>{one} </span>
      ))}
    </>
  );
  return (
    <>
      <div ref={box}>
        {onClick ? (
          <button type="button" title="Show it on the scopes" onClick={onClick}>
            {words}
          </button>
        ) : (
          <p>{words}</p>
        )}
      </div>
      {fits < sentences.length && (
        <Button size="compact-xs" variant="subtle" aria-expanded={opened} onClick={() => setOpened(!opened)}>
          {opened ? "Fewer sentences" : "More sentences"}
        </Button>
      )}
    </>
  );
}
