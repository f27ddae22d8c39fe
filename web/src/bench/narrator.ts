import { create } from "zustand";
import { useMe } from "../api/me";
import { storageName } from "../api/storage-name";
import type { Sentence } from "../api/types";
import { useBench } from "../stream/bench-store";
import { jump } from "../ui/hover";
import { send } from "./send";
import { useVote } from "./vote";

const STORED = storageName("combbench.narrator");

interface NarratorStore {
  /** Whether a line under the panels says what happens; so it is at the first visit. */
  on: boolean;
  /** The sentence that was clicked: its signals are marked. */
  chosen: Sentence | undefined;
}

export const useNarrator = create<NarratorStore>(() => ({
  on: localStorage.getItem(STORED) !== "off",
  chosen: undefined,
}));

/** Turn the line on or off; the next visit remembers. */
export function toggleNarrator(): void {
  const on = !useNarrator.getState().on;
  localStorage.setItem(STORED, on ? "on" : "off");
  useNarrator.setState({ on });
}

/** Move the scopes to the moment of a sentence; a replay that has not reached it seeks to it first. */
export function showSentence(sentence: Sentence): void {
  useNarrator.setState({ chosen: sentence });
  const { bench } = useBench.getState();
  if (bench?.replay_of && sentence.tick > bench.tick) void send({ kind: "seek", tick: sentence.span[0] });
  else jump.to({ tick: sentence.tick });
}

/** Whether a vote is open: what happens is its answer. */
export function useVoting(): boolean {
  const asked = useVote((s) => s.vote?.state);
  const mine = useMe((s) => s.me?.vote?.state);
  return (asked ?? mine) === "open";
}

/** The number of sentences about the past; a replay also has sentences about its future. */
export function useSaid(): number {
  const tick = useBench((s) => s.bench?.tick ?? 0);
  const replay = useBench((s) => Boolean(s.bench?.replay_of));
  const sentences = useBench((s) => s.narration.sentences);
  return replay ? sentences.findLastIndex((said) => said.tick <= tick) + 1 : sentences.length;
}
