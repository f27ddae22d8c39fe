import { create } from "zustand";
import { classes } from "../api/classes";
import { queryClient } from "../api/queries";
import { storageName } from "../api/storage-name";
import type { Vote } from "../api/types";
import { votes } from "../api/votes";
import { useBench } from "../stream/bench-store";
import { announce } from "./announce";
import { showPanel } from "./dock";
import { cueNow, useLecture } from "./lecture";
import { showing } from "./send";

/** The vote that the teacher's page is at. */
export const useVote = create<{ vote: Vote | undefined }>(() => ({ vote: undefined }));

export const showVote = (vote: Vote | undefined): void => useVote.setState({ vote });

/** The question that the lecture of this tab asked last, with the beginning of the lecture. */
const ASKED = storageName("combbench.asked");

/**
 * Open the vote of the cue, once in a lecture; the panel says how it goes, and asks again if that is wanted. With several
 * classes, it asks which class votes.
 */
export const askCue = showing(async () => {
  const vote = cueNow()?.vote;
  if (!vote) return;
  showPanel("vote", "view3d");
  const [groups, open] = await Promise.all([classes.all(), votes.all()]);
  const class_id = groups[0]?.id ?? null;
  const { text, diagnoser = "", when = null, right } = vote;
  const asked = `${useLecture.getState().began} ${text}`;
  const isLast = sessionStorage.getItem(ASKED) === asked;
  const isAsked = open.some(
    (one) => one.class_id === class_id && (one.state === "open" || (isLast && one.question.text === text)),
  );
  if (groups.length > 1 || isAsked) return;
  const answers = diagnoser ? (useBench.getState().bench?.diagnosers[diagnoser]?.names ?? []) : (vote.answers ?? []);
  await votes.open({ class_id, text, answers, diagnoser, when, right });
  sessionStorage.setItem(ASKED, asked);
  await queryClient.invalidateQueries({ queryKey: ["votes"] });
  announce(`The vote is open: ${text}`);
});

/** Show the answers to the vote on the page, with the right ones. */
export const revealVote = showing(async () => {
  const { vote } = useVote.getState();
  if (!vote || vote.results) return;
  await votes.reveal(vote.id);
  await queryClient.invalidateQueries({ queryKey: ["votes"] });
});
