import { Box, Button, NativeSelect } from "@mantine/core";
import { IconArrowLeft, IconRepeat } from "@tabler/icons-react";
import { useState } from "react";
import { api } from "../api/api";
import { useAnswer } from "../api/queries";
import type { Bench } from "../api/types";
import { restoreLayout } from "../bench/dock";
import { benchBefore, openBench } from "../bench/open-bench";
import { send, showing } from "../bench/send";
import { REPLAY_SPEEDS, speedItems } from "../bench/time-scale";
import { useBench } from "../stream/bench-store";
import { formatMoment } from "../ui/format";
import { Slider } from "../ui/slider";
import { openOwnBench } from "./first-bench";
import styles from "./replay-bar.module.css";

/** While the page plays a recording: where it is, how fast, which span again and again, and the way back. */
export function ReplayBar() {
  const bench = useBench((s) => (s.bench?.replay_of ? s.bench : undefined));
  return bench?.replay_of ? <Bar key={bench.id} recording={bench.replay_of} bench={bench} /> : null;
}

function Bar({ recording, bench }: { recording: string; bench: Bench }) {
  const { value: about } = useAnswer(["recording", recording], () => api.recording(recording));
  const [span, setSpan] = useState<[number, number] | undefined>(undefined);
  const [looping, setLooping] = useState(false);
  const [held, setHeld] = useState<number | undefined>(undefined);
  if (!about) return null;
  const first = about.start_tick;
  const end = first + about.ticks;
  const [from, to] = span ?? [first, end];
  const ms = (tick: number) => formatMoment(tick * about.dt_ms);
  const speed = bench.recorded_scale && bench.time_scale ? bench.time_scale / bench.recorded_scale : undefined;
  const nearest =
    speed && REPLAY_SPEEDS.reduce((a, b) => (Math.abs(Math.log(b / speed)) < Math.abs(Math.log(a / speed)) ? b : a));

  const loop = async (next: boolean, [start_tick, end_tick]: [number, number]) => {
    setLooping(next);
    const took = await send(
      next ? { kind: "loop", start_tick, end_tick } : { kind: "loop" },
      next ? "Looping" : "Plays to the end",
    );
    if (took && next && bench.state !== "running") await send({ kind: "start" });
  };
  const loopOver = (next: [number, number]) => {
    setSpan(next);
    void loop(true, next);
  };
  const leave = showing(async () => {
    const id = benchBefore();
    if (id && (await api.benches()).some((b) => b.id === id)) openBench(id);
    else await openOwnBench();
    await api.removeBench(bench.id);
  });

  return (
    <section className={`row ${styles.bar}`} aria-label="Replay">
      <strong>Replay</strong>
      <Box component="span" className="cut" maw={220}>
        {about.name}
      </Box>
      <Box pos="relative" flex="1 1 200px" p="0 8px">
        <Slider
          size="sm"
          min={first}
          max={end - 1}
          label={ms}
          thumbLabel="Position of the replay"
          value={held ?? Math.min(Math.max(bench.tick, first), end - 1)}
          onChange={setHeld}
          onChangeEnd={(tick) => {
            setHeld(undefined);
            void send({ kind: "seek", tick });
          }}
        />
        {looping && (
          <i
            className={styles.span}
            style={{
              left: `${((from - first) / (end - first)) * 100}%`,
              right: `${((end - to) / (end - first)) * 100}%`,
            }}
          />
        )}
      </Box>
      <Box component="span" c="dimmed" style={{ whiteSpace: "nowrap" }}>
        {ms(Math.min(bench.tick, end))} of {ms(first)} … {ms(end)}
      </Box>
      <NativeSelect
        aria-label="Speed of the replay"
        value={String(nearest ?? 1)}
        data={speedItems()}
        onChange={(e) =>
          send({
            kind: "time_scale",
            value: Math.min(1, (bench.recorded_scale ?? 0.002) * Number(e.currentTarget.value)),
          })
        }
      />
      <Button
        variant={looping ? "light" : "default"}
        aria-pressed={looping}
        leftSection={<IconRepeat size={15} />}
        onClick={() => void loop(!looping, [from, to])}
      >
        Loop
      </Button>
      <Button title="The loop begins here" onClick={() => loopOver([bench.tick, to > bench.tick ? to : end])}>
        from here
      </Button>
      <Button
        title="The loop ends here"
        disabled={bench.tick <= from + 2}
        onClick={() => loopOver([from, Math.min(bench.tick, end)])}
      >
        to here
      </Button>
      {about.layout && <Button onClick={() => about.layout && restoreLayout(about.layout)}>Its layout</Button>}
      <Button variant="filled" leftSection={<IconArrowLeft size={15} />} onClick={leave}>
        Leave
      </Button>
    </section>
  );
}
