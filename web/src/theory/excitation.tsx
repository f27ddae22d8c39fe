import { ActionIcon, Box, Button } from "@mantine/core";
import { IconPlus, IconX } from "@tabler/icons-react";
import { useState } from "react";
import { api } from "../api/api";
import { useAsked } from "../api/queries";
import { formatSi } from "../ui/format";
import { Formula } from "../ui/formula";
import { NumberField } from "../ui/number-field";
import { TableHead } from "../ui/table-head";
import { roundTo } from "../ui/unit-scale";
import styles from "./theory.module.css";

interface Tone {
  amplitude: number;
  frequency: number;
}

const PRESETS: { name: string; tones: Tone[] }[] = [
  { name: "A step", tones: [{ amplitude: 10, frequency: 0 }] },
  { name: "One tone", tones: [{ amplitude: 10, frequency: 0.4 }] },
  { name: "Two tones", tones: [0.1, 0.4].map((frequency) => ({ amplitude: 10, frequency })) },
  { name: "Four tones", tones: [0.1, 0.4, 0.9, 1.6].map((frequency) => ({ amplitude: 10, frequency })) },
];
const FIELDS = [
  { key: "frequency", label: "Frequency", unit: "", minimum: 0, maximum: 1000 },
  { key: "amplitude", label: "Amplitude", unit: "V", minimum: -1e6, maximum: 1e6 },
] as const;
const NAMES = ["least", "middle", "largest"];

/** Whether an input tells the three parameters of a resonator apart. */
export function Excitation() {
  const [tones, setTones] = useState(PRESETS[1].tones);
  const [a1, setA1] = useState(0.2);
  const body = { tones, gain: 1, a1, a2: 1, filter_pole: 1 };
  const { answer, refusal, waiting } = useAsked(["persistency", body], () => api.persistency(body));
  const change = (index: number, part: Partial<Tone>) =>
    setTones(tones.map((tone, i) => (i === index ? { ...tone, ...part } : tone)));
  const largest = Math.max(...(answer?.eigenvalues ?? [1]));
  return (
    <section className="card essay" aria-label="Persistent excitation">
      <h2>Does the input excite enough?</h2>
      <Formula latex="\alpha_2 I\ge\int_t^{t+\delta}\varphi\varphi^T\,d\tau\ge\alpha_1 I>0,\quad\varphi=\tfrac1{(s+\lambda)^2}[u,-\dot y,-y]^T" />
      <div className={`row ${styles.examples}`}>
        {PRESETS.map(({ name, tones: preset }) => (
          <Button key={name} size="compact-xs" onClick={() => setTones(preset)}>
            {name}
          </Button>
        ))}
      </div>
      <table className={styles.tones}>
        <TableHead names={["Frequency over ω₀", "Amplitude", ""]} />
        <tbody>
          {tones.map((tone, i) => (
            // biome-ignore lint/suspicious/noArrayIndexKey: a tone is known by its place
            <tr key={i}>
              {FIELDS.map(({ key, label, ...limits }) => (
                <td key={key}>
                  <NumberField
                    label={`${label} of tone ${i + 1}`}
                    value={tone[key]}
                    onCommit={(value) => change(i, { [key]: value })}
                    {...limits}
                  />
                </td>
              ))}
              <td>
                <ActionIcon
                  size={26}
                  disabled={tones.length < 2}
                  aria-label={`Remove tone ${i + 1}`}
                  onClick={() => setTones(tones.filter((_, j) => j !== i))}
                >
                  <IconX size={14} />
                </ActionIcon>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      <div className={`row ${styles.examples}`}>
        <Button
          size="compact-xs"
          variant="light"
          leftSection={<IconPlus size={14} />}
          disabled={tones.length >= 12}
          onClick={() =>
            setTones([
              ...tones,
              { amplitude: 10, frequency: roundTo(Math.max(...tones.map((t) => t.frequency)) + 0.3, 4) },
            ])
          }
        >
          Add a tone
        </Button>
        <span className="line note">
          damping a₁
          <NumberField label="Damping a1" unit="" value={a1} minimum={1e-6} maximum={100} onCommit={setA1} />
        </span>
      </div>
      {refusal && (
        <Box component="p" role="alert" className="wrong" my={4}>
          {refusal.body.message}
        </Box>
      )}
      {answer && (
        <div className={styles.answer} data-waiting={waiting || refusal !== undefined}>
          <p className={styles.verdict} data-good={answer.exciting}>
            {answer.exciting
              ? "Persistently exciting"
              : "Not persistently exciting: the output does not show some change of the parameters"}
          </p>
          <table className={styles.eigen}>
            <caption>Eigenvalues of the mean of φφᵀ</caption>
            <tbody>
              {answer.eigenvalues.map((value, i) => (
                <tr key={NAMES[i]}>
                  <th scope="row">{NAMES[i]}</th>
                  <td>
                    <i style={{ width: `${share(value, largest)}%` }} data-none={value <= 0} />
                  </td>
                  <td>{formatSi(Math.max(0, value), "", 3)}</td>
                </tr>
              ))}
            </tbody>
          </table>
          <p className="note">
            Condition {answer.condition === null ? "infinite" : formatSi(answer.condition, "", 3)}; smallest, with every
            component at a unit mean square, {formatSi(answer.relative, "", 3)}.
          </p>
        </div>
      )}
    </section>
  );
}

const LOWEST = 1e-8;

/** Length of a bar, logarithmic over eight decades below the largest. */
function share(value: number, largest: number): number {
  return value <= largest * LOWEST ? 0 : 100 * (1 - Math.log10(value / largest) / Math.log10(LOWEST));
}
