const STEPS_MS = [500, 1000, 2000, 5000];

/** How long to wait before connection attempt `attempt` (0, 1, ...): 0.5, 1, 2, then 5 s, +-20 %. */
export function reconnectDelay(attempt: number, random: () => number = Math.random): number {
  const base = STEPS_MS[Math.min(attempt, STEPS_MS.length - 1)];
  return base * (0.8 + 0.4 * random());
}
