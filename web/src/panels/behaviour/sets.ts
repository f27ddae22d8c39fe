/** The behaviour of a hypothesis: a disc about its output, of radius 1, the limit of the test. */
export interface Behaviour {
  name: string;
  words: string;
  /** From the middle of the disc to the measured output; within 1 the test at the tone is passed. */
  from: { x: number; y: number };
  /** Whether input and output belong to it: this test and the test of the power are passed. */
  holds: boolean;
}

/** The behaviours of a bank around the first one, and the measured output. */
export interface Sets {
  discs: { name: string; x: number; y: number; holds: boolean }[];
  measured: { x: number; y: number };
}

const VERDICTS = [
  "no fault",
  "a fault is detected",
  "a fault is isolated",
  "the fault is ambiguous",
  "an unknown fault",
];

/**
 * Place the discs around each other: the measured output has its distance from the middle of each.
 *
 * The first disc keeps its place, so that the measured output moves.
 */
export function setsOf(behaviours: readonly Behaviour[]): Sets | undefined {
  const [first] = behaviours;
  if (!first || !behaviours.every(({ from }) => Number.isFinite(from.x + from.y))) return undefined;
  return {
    measured: first.from,
    discs: behaviours.map(({ name, from, holds }) => ({
      name,
      x: first.from.x - from.x,
      y: first.from.y - from.y,
      holds,
    })),
  };
}

/** The result of the test in a sentence. */
export function setsWords(behaviours: readonly Behaviour[], verdict: number): string {
  const holding = behaviours.filter((one) => one.holds).map((one) => one.words);
  const belongs =
    holding.length === 0
      ? "Input and output belong to no behaviour of the list"
      : `Input and output belong to ${holding.length > 1 ? "the behaviours" : "the behaviour"}: ${holding.join(", ")}`;
  return VERDICTS[verdict] ? `${belongs}. The verdict: ${VERDICTS[verdict]}.` : `${belongs}.`;
}
