import { create } from "zustand";
import { client, data } from "./client";
import type { Me } from "./types";

/** What the page offers: to change the bench it shows, or what only a teacher, or somebody alone, may do. */
export type Right = "drive" | "teach";

const RIGHTS: Record<Me["role"], readonly Right[]> = {
  teacher: ["drive", "teach"],
  student: ["drive"],
  watcher: [],
};

interface MeStore {
  me: Me | undefined;
  /** The bench that the page shows. */
  at: string | undefined;
}

/** Who is at this page; asked before anything is shown. */
export const useMe = create<MeStore>(() => ({ me: undefined, at: undefined }));

/** Whether the person at this page may do something; the server decides, and the page leaves out what it would refuse. */
export function may(right: Right, role = useMe.getState().me?.role): boolean {
  if (role === undefined || !RIGHTS[role].includes(right)) return false;
  return role !== "student" || !looksOn(useMe.getState());
}

/** Whether a student only looks at the bench on the page: it is shown to all, and is not one to drive. */
const looksOn = ({ me, at }: MeStore): boolean =>
  at !== undefined && at === me?.shown && at !== me.bench && at !== me.lent;

export const useMay = (right: Right): boolean => useMe(({ me }) => may(right, me?.role));

/** Whether the page was opened by a link to watch, which shows one bench and nothing else of the server. */
export const useWatches = (): boolean => useMe(({ me }) => me?.role === "watcher");

/** Ask who is at this page, and which bench is theirs. */
export async function askMe(): Promise<Me> {
  return keep(await data(client.GET("/api/v1/me")));
}

/** Raise a hand for the teacher to see, or take it down. */
export async function raiseHand(raised: boolean): Promise<Me> {
  return keep(await data(client.PUT("/api/v1/me/hand", { body: { raised } })));
}

/** The layout that the teacher gave to all last. */
export const givenLayout = () => data(client.GET("/api/v1/me/layout"));

/**
 * Where the page of somebody goes: to a bench just handed over or just shown to all, else it stays where it may, else to
 * the own bench. Nothing: it stays.
 */
export function placeOf(me: Me, before: Me | undefined, at: string | undefined): string | undefined {
  if (me.lent && me.lent !== before?.lent) return me.lent;
  if (me.shown && me.shown !== before?.shown) return me.shown;
  const here = at !== undefined && [me.bench, me.lent, me.shown].includes(at);
  return here ? undefined : (me.bench ?? undefined);
}

/** Answer the vote of one's class, or change one's answer. */
export async function castVote(vote: string, answer: number, at_ms: number | null): Promise<void> {
  await data(client.PUT("/api/v1/me/vote", { body: { vote, answer, at_ms } }));
  await askMe();
}

function keep(me: Me): Me {
  useMe.setState({ me });
  return me;
}
