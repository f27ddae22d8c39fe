import type { BankVerdicts, DiagnosedRecord, KeptRecord } from "../api/types";
import { formatMoment, formatNumber, formatPercent } from "../ui/format";
import { HYPOTHESES, type Scheme, TRACE_COLOURS } from "../ui/palette";
import { useScheme } from "../ui/use-canvas";
import styles from "./records.module.css";

const MOST_ROWS = 40;
const UNEXPLAINED = "unexplained";
const UNSURE = "unsure";
const SAID: Record<string, string> = { [UNEXPLAINED]: "no hypothesis explains this", [UNSURE]: "none is 0.9 probable" };

/** The verdicts of each bank over the record. */
export function DiagnosisView({ diagnosis, record }: { diagnosis: DiagnosedRecord; record: KeptRecord }) {
  return (
    <section aria-label="Diagnosis">
      {diagnosis.banks.length === 0 && <p>This bench has no bank of hypotheses.</p>}
      {diagnosis.banks.map((bank) => (
        <Bank key={bank.name} bank={bank} record={record} figures={diagnosis.figures} />
      ))}
    </section>
  );
}

interface BankProps {
  bank: BankVerdicts;
  record: KeptRecord;
  figures: DiagnosedRecord["figures"];
}

function Bank({ bank, record, figures }: BankProps) {
  const scheme = useScheme();
  const words = Object.keys(bank.shares);
  const correct = figures[`diagnosis.${bank.name}.correct_fraction`];
  const rows = bank.verdicts.slice(0, MOST_ROWS);
  const left = bank.verdicts.length - rows.length + bank.left_out;
  const moment = (sample: number) => formatMoment(sample / record.rate_khz);
  return (
    <>
      <h4 className={styles.name}>{bank.name.replaceAll("_", " ")}</h4>
      <div className={styles.course} aria-hidden="true">
        {bank.verdicts.map(({ first, end, verdict }) => (
          <i
            key={first}
            title={`${verdict}, ${moment(first)} to ${moment(end)}`}
            data-verdict={verdict}
            style={{ flexGrow: end - first, background: colourOf(verdict, words, bank.healthy, scheme) }}
          />
        ))}
      </div>
      <p className={styles.shares}>
        {Object.entries(bank.shares).map(([verdict, share]) => (
          <span key={verdict}>
            <i style={{ background: colourOf(verdict, words, bank.healthy, scheme) }} /> {verdict}{" "}
            {formatPercent(share, 0)}
          </span>
        ))}
      </p>
      <ul className={styles.verdicts} aria-label={`Verdicts of ${bank.name}`}>
        {rows.map(({ first, end, verdict, probability }) => (
          <li key={first}>
            <span>
              {moment(first)} to {moment(end)}
            </span>
            <b>{verdict}</b>
            <span>{SAID[verdict] ?? `probability ${formatNumber(probability, 3)}`}</span>
          </li>
        ))}
      </ul>
      {left > 0 && <p className="note">{left} more stretches are not listed.</p>}
      <p className="note">
        {typeof correct === "number"
          ? `By the labels of the record ${formatPercent(correct)} of the labelled samples are right.`
          : "The record has no labels: the truth is not known, and there is no score."}
      </p>
    </>
  );
}

/** Grey for no verdict, the colour of alarms for unexplained, the neutral trace for health, one more for each fault. */
function colourOf(verdict: string, words: string[], healthy: string, scheme: Scheme): string {
  if (verdict === UNEXPLAINED) return "var(--alarm)";
  if (verdict === UNSURE) return "var(--line)";
  if (verdict === healthy) return "var(--running)";
  const faults = words.filter((word) => ![UNEXPLAINED, UNSURE, healthy].includes(word)).sort();
  return TRACE_COLOURS[scheme][HYPOTHESES[(1 + faults.indexOf(verdict)) % HYPOTHESES.length]];
}
