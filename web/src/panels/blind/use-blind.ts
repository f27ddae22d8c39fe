import { create } from "zustand";
import { send } from "../../app/send";
import { useView } from "../../app/view-store";
import { liftVeil, stream } from "../../stream/stream";
import { veil } from "../../stream/veil";
import { jump } from "../../ui/jump";
import type { Hypothesis } from "../hypotheses/draft";
import { faultsOf, hiddenFault, points } from "./hidden-fault";

export interface Attempt {
  seed: number;
  said: string;
  confidence: number;
  truth: string;
  points: number;
  /** Device time from the fault to the answer; 0 for none hidden. */
  tookMs: number;
  /** What the diagnosers said at that moment. */
  verdicts: Record<string, string>;
}

interface Game {
  /** What is hidden now, and when it comes. */
  hidden: { seed: number; bench: string; answer: string; dueTick: number; came: number | undefined } | undefined;
  last: Attempt | undefined;
  attempts: Attempt[];
  faultTick: number | undefined;
}

export const useGame = create<Game>(() => ({ hidden: undefined, last: undefined, attempts: [], faultTick: undefined }));

const LOOK_MS = 50;
let waiting: ReturnType<typeof setInterval> | undefined;

/** Heal the device, draw the veil, and let the seed's fault come when nobody expects it. */
export async function hide(bench: string, seed: number, hypotheses: Hypothesis[], dtMs: number): Promise<void> {
  const names = hypotheses.map((h) => h.name);
  const { answer, delayTicks } = hiddenFault(seed, names, dtMs);
  const chosen = hypotheses.find((h) => h.name === answer);
  if (!chosen || !(await send({ kind: "heal", faults: "all" }))) return;
  veil.drop();
  useView.setState({ blind: true, sample: undefined });
  const dueTick = stream.client.head.tick + delayTicks;
  useGame.setState({
    hidden: { seed, bench, answer, dueTick, came: undefined },
    last: undefined,
    faultTick: undefined,
  });
  jump.to("live");
  clearInterval(waiting);
  waiting = setInterval(() => stream.client.head.tick >= dueTick && void come(chosen), LOOK_MS);
  await send({ kind: "start" });
}

/** Let the hidden fault act. */
async function come(hypothesis: Hypothesis): Promise<void> {
  clearInterval(waiting);
  const tick = stream.client.head.tick;
  for (const command of faultsOf(hypothesis)) if (!(await send(command))) return giveUp();
  const { hidden } = useGame.getState();
  if (hidden) useGame.setState({ hidden: { ...hidden, came: tick } });
}

/** Take an answer, lift the veil and count. */
export function commit(
  { said, confidence, verdicts }: Pick<Attempt, "said" | "confidence" | "verdicts">,
  hypotheses: Hypothesis[],
  dtMs: number,
): void {
  const { hidden, attempts } = useGame.getState();
  if (!hidden) return;
  const { came } = hidden;
  const healthy = hypotheses.find((h) => faultsOf(h).length === 0)?.name ?? "none of these";
  const truth = came === undefined ? healthy : hidden.answer;
  const attempt: Attempt = {
    seed: hidden.seed,
    said,
    confidence,
    truth,
    points: points(said === truth, confidence, hypotheses.length),
    tookMs: came === undefined ? 0 : (stream.client.head.tick - came) * dtMs,
    verdicts,
  };
  useGame.setState({
    hidden: undefined,
    last: attempt,
    attempts: [...attempts, attempt],
    faultTick: came,
  });
  reveal();
}

/** End the game without an answer. */
export function giveUp(): void {
  useGame.setState({ hidden: undefined });
  reveal();
}

function reveal(): void {
  clearInterval(waiting);
  useView.setState({ blind: false });
  liftVeil();
}
