import { api } from "../api/api";
import { useBench } from "../stream/bench-store";
import { announce } from "./announce";
import { addBehind } from "./behind";
import { openBench, openOwn } from "./open-bench";
import { onBench, send, showError, showing } from "./send";
import { untilBench } from "./until-bench";

/** Ticks before a moment of the past that its panels can show. */
const WINDOW_TICKS = 20_000;
/** A moment further back is computed for so long that the bench that shows the past is made first, and says how far it is. */
const FAR_TICKS = 1_000_000;
/** Between two looks whether another moment is wanted while one is computed. */
const LOOK_MS = 50;
/** How long a bench may take to say hello. */
const HELLO_MS = 10_000;

/** As the server allows. */
const LONGEST_NAME = 80;

let wanted: number | undefined;
let following = false;

/** Show the bench as it was at a tick; of several ticks asked for in quick succession the last is shown. */
export function lookBack(tick: number): void {
  wanted = tick;
  if (!following) void follow();
}

async function follow(): Promise<void> {
  following = true;
  try {
    while (wanted !== undefined) {
      const tick = wanted;
      wanted = undefined;
      const bench = useBench.getState().bench;
      if (!bench) return;
      if (bench.origin?.is_past) await seek(bench.id, tick);
      else {
        const first = bench.tick - tick > FAR_TICKS ? bench.tick : tick;
        await standAt(bench.id, first);
        if (first !== tick) wanted ??= tick;
      }
    }
  } catch (error) {
    wanted = undefined;
    showError(error);
  } finally {
    following = false;
  }
}

/** Let a bench show another moment; ends when it does, or when another is wanted, which the server computes instead. */
async function seek(id: string, tick: number): Promise<void> {
  let isThere = false;
  const shown = api.seek(id, tick).finally(() => {
    isThere = true;
  });
  while (!isThere && wanted === undefined) await Promise.race([shown, pause(LOOK_MS)]);
  if (isThere) await shown;
  else shown.catch(() => {}); // given up
}

const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

/** Wait until the page shows a bench. */
const helloOf = (id: string): Promise<void> =>
  untilBench(({ bench, connection }) => bench?.id === id && connection.phase === "open", HELLO_MS);

/** Go back from the past to the bench it is of; a bench that only showed the past is closed. */
export const backToNow = onBench(async ({ id, origin }) => {
  if (!origin) return;
  await api.reopenBench(origin.bench); // the server may have closed it
  openBench(origin.bench, true, true);
  if (origin.is_past) await api.removeBench(id);
});

/** Show a bench at the moment shown, as the start of a branch. */
async function standHere(): Promise<string | undefined> {
  const bench = useBench.getState().bench;
  if (!bench || bench.origin?.is_past) return bench?.id;
  return standAt(bench.id, bench.tick);
}

/** Fork a bench at a tick and show the fork. */
async function standAt(of: string, tick: number): Promise<string> {
  const made = await api.fork(of, { tick, paused: true, window_ticks: WINDOW_TICKS });
  openBench(made.id, false, true);
  await helloOf(made.id);
  return made.id;
}

/** Go on from the moment that is shown, of the past or now, as a bench of its own with a name. */
export const goOn = showing(async (name: string, change?: () => Promise<boolean>) => {
  const id = await standHere();
  if (!id || (change && !(await change()))) return;
  await api.nameBench(id, name.slice(0, LONGEST_NAME)).catch(showError);
  if (await send({ kind: "start" }, "A branch starts here")) openOwn(id, true);
});

/** Start a branch at the moment shown with other values from tick 0 on; all commands are repeated. */
export const goOnHaving = onBench(async (bench, name: string, set: Record<string, unknown>) => {
  const made = await api.variant(bench.id, set, true);
  await api.nameBench(made.id, name.slice(0, LONGEST_NAME));
  const isPast = bench.origin?.is_past ?? false;
  openOwn(made.id, isPast);
  await helloOf(made.id);
  await addBehind(isPast && bench.origin ? bench.origin.bench : bench.id);
  if (isPast) await api.removeBench(bench.id);
  await send({ kind: "start" }, "A branch starts here; all commands were replayed");
});

/** Fork the bench before the commands of a tick, and run it without them. */
export const goOnWithout = onBench(async (bench, tick: number, words: string) => {
  const made = await api.fork(bench.id, {
    tick,
    before: true,
    paused: true,
    window_ticks: WINDOW_TICKS,
    name: `without ${words}`.slice(0, LONGEST_NAME),
  });
  openOwn(made.id);
  await helloOf(made.id);
  await send({ kind: "start" });
  announce(`A branch without this: ${words}.`);
});

/** Fork a bench that has tripped from shortly before. */
export const forkBeforeTrip = onBench(async (bench) => {
  if (!bench.trip) return;
  const before = Math.round(BEFORE_TRIP_PERIODS * (bench.drive_period_ticks ?? BEFORE_TRIP_TICKS));
  const tick = Math.max(bench.trip.tick - before, bench.earliest_tick ?? 0);
  const made = await api.fork(bench.id, { tick, paused: true, window_ticks: WINDOW_TICKS });
  openOwn(made.id);
  announce(`A branch from ${bench.trip.tick - tick} ticks before the trip; it waits.`);
});

const BEFORE_TRIP_PERIODS = 10;
const BEFORE_TRIP_TICKS = 100;
