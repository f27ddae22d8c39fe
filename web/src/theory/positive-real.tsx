import { Box, Button, Group, TextInput } from "@mantine/core";
import { useMemo, useState } from "react";
import { api } from "../api/api";
import { useAsked } from "../api/queries";
import type { PositiveReal as Found } from "../api/types";
import { Painted } from "../picture/painted";
import type { Look, Box as Paper, Pen } from "../picture/pen";
import { PictureMenu } from "../picture/picture-menu";
import { formatShort, formatSi } from "../ui/format";
import { Formula } from "../ui/formula";
import { paintNyquist, paintOverFrequency, realPartPicture } from "./paint-real-part";
import styles from "./theory.module.css";
import { highestFirst, NotRational, parseTransferFunction, transferLatex } from "./transfer-function";

const EXAMPLES = [
  "(s+1)/(s^2+5s+6)",
  "1/(s^2+0.2s+1)",
  "(s+3)/((s+1)(s+2))",
  "(s+2)/((s+1)(s+0.5))",
  "1/s",
  "(s-1)/(s+2)",
];

/** Type a transfer function: is it positive real, and where is its real part least. */
export function PositiveReal() {
  const [text, setText] = useState(EXAMPLES[0]);
  const parsed = useMemo(() => read(text), [text]);
  const [last, setLast] = useState(parsed.found);
  if (parsed.found && parsed.found !== last) setLast(parsed.found);
  const numerator = last ? highestFirst(last.numerator) : [1];
  const denominator = last ? highestFirst(last.denominator) : [1];
  const { answer, refusal, waiting } = useAsked(["positive real", numerator, denominator], () =>
    api.positiveReal(numerator, denominator),
  );
  return (
    <section className="card essay" aria-label="Positive real">
      <h2>Is it positive real?</h2>
      <p className="note">
        A transfer function in s. Lyapunov's rule is proved stable only where it is strictly positive real.
      </p>
      <TextInput
        size="sm"
        label="G(s)"
        spellCheck={false}
        value={text}
        error={parsed.why ?? refusal?.body.message}
        onChange={(e) => setText(e.currentTarget.value)}
      />
      <div className={`row ${styles.examples}`}>
        {EXAMPLES.map((example) => (
          <Button key={example} size="compact-xs" onClick={() => setText(example)}>
            {example}
          </Button>
        ))}
      </div>
      {last && <Formula latex={transferLatex(last)} />}
      {answer && (
        <div className={styles.answer} data-waiting={waiting || parsed.why !== undefined}>
          <p className={styles.verdict} data-good={answer.strictly_positive_real}>
            {answer.strictly_positive_real
              ? "Strictly positive real"
              : answer.positive_real
                ? "Positive real, but not strictly"
                : "Not positive real"}
          </p>
          {answer.reasons.length > 0 && (
            <Box component="ul" mb={8} pl={18} fz="sm">
              {answer.reasons.map((reason) => (
                <li key={reason}>{reason}</li>
              ))}
            </Box>
          )}
          <dl className={styles.facts}>
            {factsOf(answer).map(([name, fact]) => (
              <div key={name}>
                <dt>{name}</dt>
                <dd>{fact}</dd>
              </div>
            ))}
          </dl>
          <Group justify="flex-end">
            <PictureMenu name="real part" take={() => realPartPicture(answer, text)} />
          </Group>
          <RealPart found={answer} />
        </div>
      )}
    </section>
  );
}

const yes = (is: boolean) => (is ? "yes" : "no");
const leastWords = ({ least_real }: Found) => (least_real === null ? "unbounded" : formatShort(least_real, ""));

const factsOf = (answer: Found): [string, string][] => [
  ["poles to the left", yes(answer.hurwitz)],
  ["zeros to the left", yes(answer.minimum_phase)],
  ["relative degree", String(answer.relative_degree)],
  ["least Re G(jω)", leastWords(answer) + (answer.at === null ? " at infinity" : ` at ω = ${formatSi(answer.at, "")}`)],
];

/** Re G(jw) over frequency, and the Nyquist curve next to it or below. */
function RealPart({ found }: { found: Found }) {
  const [overFrequency, nyquist] = useMemo(
    () =>
      [paintOverFrequency, paintNyquist].map(
        (paint) => (pen: Pen, box: Paper, look: Look) => paint(pen, box, found, look),
      ),
    [found],
  );
  return (
    <div className={styles.plots}>
      <Painted label={`Real part over frequency; least ${leastWords(found)}`} paint={overFrequency} />
      <Painted label="Nyquist curve: imaginary over real part" paint={nyquist} />
    </div>
  );
}

function read(text: string) {
  try {
    return { found: parseTransferFunction(text), why: undefined };
  } catch (error) {
    if (!(error instanceof NotRational)) throw error;
    return { found: undefined, why: error.message };
  }
}
