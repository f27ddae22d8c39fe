import { Box, Button, Group } from "@mantine/core";
import { IconWaveSine } from "@tabler/icons-react";
import { useMemo } from "react";
import type { Signal } from "../../api/types";
import { addScope } from "../../bench/dock";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { useBench } from "../../stream/bench-store";
import { formatNumber, formatPercent } from "../../ui/format";
import { useLiveValues } from "../schematic/use-live-values";
import styles from "./card.module.css";
import { type Instance, ownSignals } from "./instances";

const MOST = 24;

/** Outputs and inner signals of a block, as numbers now. */
export function LiveValues({ instance }: { instance: Instance }) {
  const signals = useBench((s) => s.bench?.signals);
  const own = useMemo(() => ownSignals(instance, signals ?? []).slice(0, MOST), [instance, signals]);
  const shown = useMemo(() => Object.fromEntries(own.map((s) => [s.name, s.name])), [own]);
  const names = useBench((s) => s.bench?.diagnosers[instance.id.split(".").at(-1) ?? ""]?.names);
  const scored = useMemo(() => new Set(own.filter((s) => s.block.endsWith(".score")).map((s) => s.name)), [own]);
  const live = useLiveValues(shown, (name, value) => {
    if (scored.has(name)) return scoreWords(name, value, names ?? []);
    return PROBABILITY.test(name) ? formatPercent(value) : undefined;
  });
  if (own.length === 0) return null;
  return (
    <section className={styles.live} aria-label="Live values">
      <Group justify="space-between">
        <Box component="h3" fz="sm">
          Now
        </Box>
        <Button
          size="compact-xs"
          variant="subtle"
          leftSection={<IconWaveSine size={14} />}
          onClick={() => addScope(instance.title, Object.keys(shown).slice(0, 6))}
        >
          Open in a scope
        </Button>
      </Group>
      <dl>
        {own.map((signal) => (
          <div key={signal.name} title={`${signal.name}: ${signal.meaning}`}>
            <dt>
              {bare(signal)}
              <small>{signal.meaning}</small>
            </dt>
            <dd ref={live(signal.name)} />
          </div>
        ))}
      </dl>
    </section>
  );
}

const PROBABILITY = /\.probability\.(.+)$/;

function bare({ name }: Signal): string {
  const hypothesis = PROBABILITY.exec(name)?.[1];
  if (hypothesis) return hypothesisWords(hypothesis);
  return name
    .slice(name.indexOf(".") + 1)
    .replaceAll("_", " ")
    .replaceAll(".", " ");
}

const COUNTS = ["false_switches", "delay"];

/**
 * A figure of the score of a diagnoser in words: hypotheses by name, counts whole, shares in percent; undefined for other
 * figures.
 */
export function scoreWords(signal: string, value: number, names: readonly string[]): string | undefined {
  const port = signal.slice(signal.lastIndexOf(".") + 1);
  if (port === "winner" || port === "truth") return names[value] ? hypothesisWords(names[value]) : "none of these";
  if (port === "delay" && value < 0) return "not found";
  if (COUNTS.includes(port)) return formatNumber(value, 0);
  if (port === "correct_fraction") return formatPercent(value, 2);
  return undefined;
}
