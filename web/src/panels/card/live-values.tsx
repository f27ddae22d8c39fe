import { Button } from "@mantine/core";
import { IconWaveSine } from "@tabler/icons-react";
import { useMemo } from "react";
import type { Signal } from "../../api/types";
import { addScope } from "../../bench/dock";
import { useBench } from "../../stream/bench-store";
import { useLiveValues } from "../schematic/use-live-values";
import styles from "./card.module.css";
import type { Instance } from "./instances";
import { ownSignals } from "./own-signals";
import { scoreWords } from "./score-words";

const MOST = 24;

/** What a block puts out and what goes on inside it, as numbers now. */
export function LiveValues({ instance }: { instance: Instance }) {
  const signals = useBench((s) => s.bench?.signals);
  const own = useMemo(() => ownSignals(instance, signals ?? []).slice(0, MOST), [instance, signals]);
  const shown = useMemo(() => Object.fromEntries(own.map((s) => [s.name, s.name])), [own]);
  const names = useBench((s) => s.bench?.diagnosers[instance.id.split(".").at(-1) ?? ""]?.names);
  const scored = useMemo(() => new Set(own.filter((s) => s.block.endsWith(".score")).map((s) => s.name)), [own]);
  const live = useLiveValues(shown, (name, value) =>
    scored.has(name) ? scoreWords(name, value, names ?? []) : undefined,
  );
  if (own.length === 0) return null;
  return (
    <section className={styles.live} aria-label="Live values">
      <header>
        <h3>Now</h3>
        <Button
          size="compact-xs"
          variant="subtle"
          leftSection={<IconWaveSine size={14} />}
          onClick={() =>
            addScope(
              instance.title,
              own.slice(0, 6).map((s) => s.name),
            )
          }
        >
          Open in a scope
        </Button>
      </header>
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

const bare = (signal: Signal) =>
  signal.name
    .slice(signal.name.indexOf(".") + 1)
    .replaceAll("_", " ")
    .replaceAll(".", " ");
