import { Menu, UnstyledButton } from "@mantine/core";
import { IconChevronDown, IconPlus, IconSchool, IconTrash } from "@tabler/icons-react";
import { useEffect, useState } from "react";
import { api } from "../../api/api";
import { lectures } from "../../api/lectures";
import { useMay, useServed } from "../../api/me";
import { useAsked } from "../../api/queries";
import type { Bench } from "../../api/types";
import { actions } from "../../bench/actions";
import { startLecture } from "../../bench/lecture";
import { openBench, ownBench } from "../../bench/open-bench";
import { showError } from "../../bench/send";
import { useBench } from "../../stream/bench-store";
import { staleWords, useStaleSince } from "../../stream/freshness";
import { formatShort } from "../../ui/format";
import styles from "./header.module.css";

/** Which bench this is; the others that run; a new one. */
export function BenchMenu() {
  const id = useBench((s) => s.bench?.id);
  const title = useBench((s) => s.bench?.title);
  const rate = useBench((s) => s.bench?.sample_rate_khz);
  const watchers = useBench((s) => s.bench?.watchers ?? 0);
  const stale = useStaleSince();
  const slow = useSlowPage() && !stale;
  const drives = useMay("drive");
  const teaches = useMay("teach");
  const hasSeveral = useMay("branch");
  const served = useServed();
  const [benches, setBenches] = useState<Bench[]>([]);
  const [name, rest] = (title ?? "No bench").split(/: (.*)/);
  const news = stale ? staleWords(stale) : slow ? "display lagging" : rate ? rest : "connecting";
  const load = () => api.benches().then(setBenches, showError);

  return (
    <Menu width={340} position="bottom-start" onOpen={load}>
      <Menu.Target>
        <UnstyledButton
          className={styles.bench}
          aria-label={news && news !== rest ? `${name} ${news}` : (title ?? "No bench")}
          title={[
            `${title ?? "No bench"}: change bench.`,
            ...(stale ? [] : [`${formatShort(rate ?? 0, "kHz")} board, ${watchers} watching.`]),
            ...(slow ? ["The display lags, the simulation is on time."] : []),
          ].join(" ")}
        >
          <span className="cut" data-lines={news ? 1 : 2}>
            {name}{" "}
          </span>
          <small className="cut" data-slow={slow}>
            {news}
            <IconChevronDown size={12} style={{ verticalAlign: -2 }} />
          </small>
        </UnstyledButton>
      </Menu.Target>
      <Menu.Dropdown>
        {drives && served && (
          <>
            <Menu.Item leftSection={<IconPlus size={16} />} onClick={actions.newBench}>
              New bench
            </Menu.Item>
            <Menu.Divider />
          </>
        )}
        {teaches && <Lectures />}
        <Menu.Label>
          {!served ? "In this page" : teaches ? "On this server" : drives ? "Your bench" : "You watch"}
        </Menu.Label>
        {benches.map((b) => (
          <Menu.Item
            key={b.id}
            aria-current={b.id === id}
            fw={b.id === id ? 650 : undefined}
            onClick={() => b.id !== id && openBench(b.id)}
            rightSection={b.id === id || !hasSeveral ? undefined : <Remove bench={b} onDone={load} />}
          >
            {b.title}
            <small>
              {b.id === ownBench() && "yours · "}
              {b.state} · {b.controller.replaceAll("_", " ")} · {b.watchers} watching
            </small>
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}

/** The lectures, each at a press. */
function Lectures() {
  const { answer: value } = useAsked(["lectures"], lectures.all);
  return (
    <>
      <Menu.Label>Lectures</Menu.Label>
      {(value ?? []).map(({ id, title, minutes }) => (
        <Menu.Item key={id} leftSection={<IconSchool size={16} />} onClick={() => void startLecture(id)}>
          {title}
          <small>{formatShort(minutes, "min")}, with notes for the speaker</small>
        </Menu.Item>
      ))}
      <Menu.Divider />
    </>
  );
}

function Remove({ bench, onDone }: { bench: Bench; onDone(): void }) {
  return (
    // biome-ignore lint/a11y/useSemanticElements: a button may not contain another button
    <span
      role="button"
      tabIndex={-1}
      title={`Stop and remove ${bench.title}`}
      onClick={(event) => {
        event.stopPropagation();
        if ((bench.watchers ?? 0) > 0 && !window.confirm(`${bench.watchers} people watch ${bench.title}. Remove it?`))
          return;
        api.removeBench(bench.id).then(onDone, showError);
      }}
      onKeyDown={() => undefined}
    >
      <IconTrash size={15} />
    </span>
  );
}

const SHOWN_MS = 8000;

/** Whether the server said a moment ago that this page takes frames too slowly. */
function useSlowPage(): boolean {
  const notice = useBench((s) => (s.notice?.code === "slow_client" ? s.notice : undefined));
  const [slow, setSlow] = useState(false);
  useEffect(() => {
    if (!notice) return;
    setSlow(true);
    const timer = setTimeout(() => setSlow(false), SHOWN_MS);
    return () => clearTimeout(timer);
  }, [notice]);
  return slow;
}
