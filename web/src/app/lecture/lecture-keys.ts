import { actions } from "../../bench/actions";
import { cueBefore, nextCue } from "../../bench/lecture";
import { askCue, revealVote } from "../../bench/vote";
import { askLatest } from "../../bench/why";
import { type KeyBinding, keyOf } from "../key-binding";

const key = keyOf("Run");

/** The keys of a lecture, in the window of the bench and in the window of the notes; a clicker sends Page Down and Page Up. */
export const LECTURE_KEYS: KeyBinding[] = [
  key(" ", "Space", "next cue of the lecture", nextCue),
  key("PageDown", "Page Down", "next cue", nextCue),
  key("ArrowRight", "→", "next cue", nextCue),
  key("PageUp", "Page Up", "cue before", cueBefore),
  key("ArrowLeft", "←", "cue before", cueBefore),
  key("r", "R", "run or pause the bench", actions.toggle),
  key("a", "A", "open the vote of the cue", () => void askCue()),
  key("x", "X", "reveal the votes", () => void revealVote()),
  key("w", "W", "why the newest verdict", askLatest),
];
