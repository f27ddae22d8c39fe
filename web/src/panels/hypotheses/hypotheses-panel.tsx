import { Box, Button, NativeSelect } from "@mantine/core";
import { IconPlus } from "@tabler/icons-react";
import { useState } from "react";
import { api } from "../../api/api";
import { fits } from "../../api/fits";
import { useMay } from "../../api/me";
import { useAsked } from "../../api/queries";
import { useCatalog } from "../../api/use-catalog";
import { openVariant } from "../../bench/open-bench";
import { useBusy } from "../../bench/use-busy";
import { useBench } from "../../stream/bench-store";
import { EmptyState } from "../../ui/empty-state";
import { RestartButton } from "../restart/restart-button";
import { AliasPlot } from "./alias-plot";
import { AliasWords } from "./alias-words";
import { another, type Hypothesis, MOST, refusal } from "./draft";
import styles from "./hypotheses.module.css";
import { HypothesisTable } from "./hypothesis-table";

type Banks = Record<string, { kind?: string; hypotheses?: Hypothesis[] }>;

/** The hypotheses of a bank: edit them, find coinciding ones, restart with the new list. */
export function HypothesesPanel() {
  const bench = useBench((s) => s.bench?.id);
  const parameters = useBench((s) => s.bench?.parameters);
  const { blocks } = useCatalog();
  const banks = Object.entries((parameters?.diagnosers ?? {}) as Banks).filter(([, { hypotheses }]) => hypotheses);
  const [wanted, setWanted] = useState<string | undefined>(undefined);
  const [drafts, setDrafts] = useState<Record<string, Hypothesis[]>>({});
  const [busy, during] = useBusy();
  const teaches = useMay("teach");
  const [id, bank] = banks.find(([name]) => name === wanted) ?? banks[0] ?? [];
  const key = `${bench} ${id}`;
  const list = drafts[key] ?? bank?.hypotheses ?? [];
  const wrong = refusal(list);
  const { answer, refusal: refused } = useAsked(
    bench && id && !wrong ? ["aliases", key, list, parameters?.reference] : undefined,
    () => api.aliases(bench ?? "", id ?? "", { hypotheses: list.map(whole) }),
  );
  if (!bench || !id || !bank)
    return (
      <EmptyState title="No bank on this bench">
        Open a scenario of chapter 5 from New bench; its list of hypotheses can be edited here.
      </EmptyState>
    );

  const changed = JSON.stringify(list) !== JSON.stringify(bank.hypotheses);
  const race = (kind: string) =>
    during(() =>
      openVariant({ [`diagnosers.${kind}`]: { kind, hypotheses: list } }, "The bench restarts with another method."),
    );
  const kinds = blocks.filter(
    (b) => b.family === "diagnose" && fits(b, []) && b.parameters.some((p) => p.name === "hypotheses"),
  );
  return (
    <section className="view-page" aria-label="Hypotheses">
      <Box className="row" pb={8}>
        <NativeSelect
          aria-label="Bank"
          value={id}
          data={banks.map(([name]) => ({ value: name, label: name.replaceAll("_", " ") }))}
          onChange={(e) => setWanted(e.currentTarget.value)}
        />
        <Button
          variant="light"
          leftSection={<IconPlus size={14} />}
          disabled={list.length >= MOST}
          onClick={() => setDrafts({ ...drafts, [key]: [...list, another(list)] })}
        >
          Hypothesis
        </Button>
        {changed && (
          <Button
            onClick={() => {
              const { [key]: _, ...rest } = drafts;
              setDrafts(rest);
            }}
          >
            As it was
          </Button>
        )}
        <RestartButton
          variant="filled"
          disabled={!changed || wrong !== undefined}
          set={{ [`diagnosers.${id}.hypotheses`]: list }}
          said="The bench restarts with the new list."
        >
          Restart with this list
        </RestartButton>
        {teaches && (
          <NativeSelect
            aria-label="Let another method race on the same list"
            value=""
            disabled={busy || wrong !== undefined}
            data={[
              { value: "", label: "Race another method…" },
              ...kinds
                .filter((b) => !(b.name in Object.fromEntries(banks)))
                .map((b) => ({ value: b.name, label: b.title })),
            ]}
            onChange={(e) => e.currentTarget.value && void race(e.currentTarget.value)}
          />
        )}
      </Box>
      {wrong && (
        <Box component="p" role="alert" className="wrong" m="4px 0">
          {wrong}
        </Box>
      )}
      <div className={styles.halves}>
        <HypothesisTable list={list} onChange={(next) => setDrafts({ ...drafts, [key]: next })} />
        <div>
          <Box component="h2" m="4px 0">
            Which of them coincide under this drive?
          </Box>
          {refused && (
            <Box component="p" role="alert" className="wrong" m="4px 0">
              {refused.body.message}. {refused.body.hint}
            </Box>
          )}
          {answer && !refused && (
            <>
              <AliasPlot report={answer} />
              <AliasWords report={answer} />
            </>
          )}
        </div>
      </div>
    </section>
  );
}

const whole = (one: Hypothesis) => ({ mass: 1, stiffness: 1, damping: 1, gain: 1, ...one });
