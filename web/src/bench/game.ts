import { create } from "zustand";
import type { HandedIn } from "../api/types";

interface Game {
  /** Id of the game chosen. */
  game: string;
  seed: number;
  /** The values to hand in that differ from the defaults. */
  values: HandedIn;
}

/** The game chosen in this page; it outlives the panel, which a phone opens and closes. */
export const useGame = create<Game>(() => ({ game: "be-the-filter", seed: 1, values: {} }));

/** Choose another game or seed; the values set for the previous one are dropped. */
export function chooseGame(game: string, seed: number): void {
  const now = useGame.getState();
  if (now.game !== game || now.seed !== seed) useGame.setState({ game, seed, values: {} });
}

/** Set one of the numbers to be handed in. */
export const setValue = (name: string, value: number | string): void =>
  useGame.setState(({ values }) => ({ values: { ...values, [name]: value } }));
