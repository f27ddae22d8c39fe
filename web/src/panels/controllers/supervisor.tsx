import { Text } from "@mantine/core";
import { useCatalog } from "../../api/use-catalog";
import { hypothesisWords } from "../../bench/hypothesis-words";
import { useBench } from "../../stream/bench-store";
import { formatCount, formatMoment, formatShort } from "../../ui/format";

/** The verdict of the supervisor, the time it waits, its last act and the reason. */
export function Supervisor() {
  const now = useBench((s) => s.bench?.supervisor);
  const dt = useBench((s) => s.bench?.dt_ms) ?? 0;
  const { block } = useCatalog();
  if (!now) return null;
  const last = now.last_act;
  return (
    <Text component="div" fz="sm">
      <p>
        <b>{block("supervise", now.kind)?.title ?? now.kind}</b>
      </p>
      <p>{verdict(now)}</p>
      {!!now.dead_ms && <p>Nothing counts for another {formatShort(now.dead_ms, "ms", 2)}.</p>}
      <p role="status">
        {last
          ? `Last act, at ${formatMoment(last.tick * dt)}: it ${last.text}, because ${last.reason}.`
          : "It has not acted."}
        {now.acts > 1 && ` ${formatCount(now.acts, "act")} so far.`}
      </p>
    </Text>
  );
}

function verdict({ diagnoser, verdict, acting, held_ms }: Status): string {
  if (held_ms == null) return `It follows ${diagnoser}.`;
  const acted = acting && acting !== verdict ? ` It acted on ${words(acting)} last.` : "";
  if (!verdict) return `${diagnoser} has no verdict.${acted}`;
  return `${diagnoser} has named ${words(verdict)} for ${formatShort(held_ms, "ms", 2)}.${acted}`;
}

type Status = NonNullable<NonNullable<ReturnType<typeof useBench.getState>["bench"]>["supervisor"]>;

/** `none fits` is no hypothesis. */
const words = (name: string) => (name === "none fits" ? "no hypothesis that fits" : hypothesisWords(name));
