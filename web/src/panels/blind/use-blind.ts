import { create } from "zustand";
import { send } from "../../bench/send";
import { useView } from "../../bench/view-store";
import { useBench } from "../../stream/bench-store";
import { dropVeil, liftVeil, stream } from "../../stream/stream";
import { veil } from "../../stream/veil";
import { jump } from "../../ui/hover";
import type { Hypothesis } from "../hypotheses/draft";
import { faultsOf, hiddenFault, points } from "./hidden-fault";

export interface Attempt {
  seed: number;
  said: string;
  confidence: number;
  truth: string;
  points: number;
  /** Device time from the fault to the answer; null if none had come. */
  tookMs: number | null;
  /** What the diagnosers said at that moment. */
  verdicts: Record<string, string>;
}

interface Hidden {
  seed: number;
  bench: string;
  hypothesis: Hypothesis;
  /** When it is to come, and when it came. */
  dueTick: number;
  came?: number;
}

interface Game {
  hidden: Hidden | undefined;
  last: Attempt | undefined;
  attempts: Attempt[];
  faultTick: number | undefined;
}

export const useGame = create<Game>(() => ({ hidden: undefined, last: undefined, attempts: [], faultTick: undefined }));

const LOOK_MS = 50;
/** A page that is loaded again goes on with the game. */
const STORED = "combbench.hidden";
let waiting: ReturnType<typeof setInterval> | undefined;

/** Heal the device, draw the veil, and let the seed's fault come when nobody expects it. */
export async function hide(bench: string, seed: number, hypotheses: Hypothesis[], dtMs: number): Promise<void> {
  const names = hypotheses.map((h) => h.name);
  const { answer, delayTicks } = hiddenFault(seed, names, dtMs);
  const hypothesis = hypotheses.find((h) => h.name === answer);
  if (!hypothesis || !(await send({ heal: "all" }))) return;
  jump.to("live");
  begin({ seed, bench, hypothesis, dueTick: stream.client.head.tick + delayTicks });
  await send({ kind: "start" });
}

function begin(hidden: Hidden): void {
  dropVeil(hidden.bench);
  useView.setState({ sample: undefined });
  useGame.setState({ hidden, last: undefined, faultTick: undefined });
  sessionStorage.setItem(STORED, JSON.stringify(hidden));
  clearInterval(waiting);
  if (hidden.came !== undefined) return;
  waiting = setInterval(() => {
    if (veil.on && stream.client.head.tick >= hidden.dueTick) void come(hidden);
  }, LOOK_MS);
}

/** Let the hidden fault act. */
async function come(hidden: Hidden): Promise<void> {
  clearInterval(waiting);
  const now = { ...hidden, came: stream.client.head.tick };
  for (const command of faultsOf(hidden.hypothesis)) if (!(await send(command))) return giveUp();
  if (!useGame.getState().hidden) return;
  useGame.setState({ hidden: now });
  sessionStorage.setItem(STORED, JSON.stringify(now));
}

/** Take an answer, lift the veil and count. */
export function commit(
  { said, confidence }: Pick<Attempt, "said" | "confidence">,
  hypotheses: Hypothesis[],
  dtMs: number,
): void {
  const { hidden, attempts } = useGame.getState();
  if (!hidden) return;
  const { came } = hidden;
  const { tick } = stream.client.head;
  reveal();
  const healthy = hypotheses.find((h) => faultsOf(h).length === 0)?.name ?? "none of these";
  const truth = came === undefined ? healthy : hidden.hypothesis.name;
  const attempt: Attempt = {
    seed: hidden.seed,
    said,
    confidence,
    truth,
    points: points(said === truth, confidence, hypotheses.length),
    tookMs: came === undefined || truth === healthy ? null : (tick - came) * dtMs,
    verdicts: verdicts(),
  };
  useGame.setState({
    hidden: undefined,
    last: attempt,
    attempts: [...attempts, attempt],
    faultTick: truth === healthy ? undefined : came,
  });
}

/** What the diagnosers say now. */
function verdicts(): Record<string, string> {
  const { bench, scores } = useBench.getState();
  return Object.fromEntries(
    Object.entries(scores).map(([id, score]) => [id, bench?.diagnosers[id]?.names[score.winner] ?? "–"]),
  );
}

/** End the game without an answer. */
export function giveUp(): void {
  useGame.setState({ hidden: undefined });
  reveal();
}

function reveal(): void {
  clearInterval(waiting);
  sessionStorage.removeItem(STORED);
  liftVeil();
}

const stored = sessionStorage.getItem(STORED);
if (stored) begin(JSON.parse(stored) as Hidden);
