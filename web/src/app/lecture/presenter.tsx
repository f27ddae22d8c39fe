import { Button } from "@mantine/core";
import { useEffect, useState } from "react";
import type { Cue } from "../../api/types";
import { cueBefore, nextCue, plannedTo, useLecture } from "../../bench/lecture";
import { askCue } from "../../bench/vote";
import styles from "./lecture.module.css";
import { ClockFace, Notes, useMinutesSince } from "./notes";

const CHANNEL = "combbench.lecture";
const PARAMETER = "notes";

/** What the window of the speaker is told, and what it asks for. */
interface Told {
  cue: Cue | undefined;
  next: string | undefined;
  place: string;
  began: number;
  planned: number;
  whole: number;
}
type Asked = "tell" | "next" | "back" | "vote";

/** Whether this window is that of the speaker. */
export const isPresenter = (): boolean => new URLSearchParams(window.location.search).get(PARAMETER) === "1";

export const openPresenter = () =>
  void window.open(`./?${PARAMETER}=1`, "combbench-notes", "popup,width=720,height=620");

/** Tell the window of the speaker, if there is one, where the lecture is; and do what is asked there. */
export function usePresenter(): void {
  const runs = useLecture((s) => s.lecture !== undefined);
  useEffect(() => {
    if (!runs) return;
    const channel = new BroadcastChannel(CHANNEL);
    const tell = () => channel.postMessage(told());
    channel.onmessage = ({ data }: MessageEvent<Asked>) => {
      if (data === "next") nextCue();
      else if (data === "back") cueBefore();
      else if (data === "vote") void askCue();
      else tell();
    };
    tell();
    const unsubscribe = useLecture.subscribe(tell);
    return () => {
      unsubscribe();
      channel.close();
    };
  }, [runs]);
}

function told(): Told {
  const { lecture, at, began } = useLecture.getState();
  const script = lecture?.script ?? [];
  return {
    cue: script[at],
    next: script[at + 1]?.title,
    place: `${at + 1} of ${script.length}`,
    began,
    planned: plannedTo(script, at),
    whole: lecture?.minutes ?? 0,
  };
}

const KEYS: Record<string, Asked> = {
  " ": "next",
  PageDown: "next",
  ArrowRight: "next",
  PageUp: "back",
  ArrowLeft: "back",
  a: "vote",
};

/** The window of the speaker: the notes in large letters, on a screen that the audience does not see. */
export function Presenter() {
  const [now, setNow] = useState<Told | undefined>(undefined);
  const [channel] = useState(() => new BroadcastChannel(CHANNEL));
  const used = useMinutesSince(now?.began ?? 0);
  useEffect(() => {
    document.title = "Notes of the speaker";
    const ask = (what: Asked) => channel.postMessage(what);
    channel.onmessage = ({ data }: MessageEvent<Told | Asked>) => typeof data === "object" && setNow(data);
    const press = (event: KeyboardEvent) => {
      const asked = KEYS[event.key];
      if (!asked || (event.key === " " && (event.target as HTMLElement).closest("button"))) return;
      event.preventDefault();
      ask(asked);
    };
    window.addEventListener("keydown", press);
    ask("tell");
    return () => window.removeEventListener("keydown", press);
  }, [channel]);
  if (!now?.cue)
    return (
      <main className={styles.presenter}>
        <h1>No lecture runs</h1>
        <p>Begin one in the window of the bench; the notes appear here.</p>
      </main>
    );
  return (
    <main className={styles.presenter}>
      <h1>
        <span>{now.place}</span> {now.cue.title}
      </h1>
      <ClockFace used={used} planned={now.planned} whole={now.whole} />
      <Notes cue={now.cue} next={now.next} />
      <p className={styles.bar}>
        <Button variant="default" onClick={() => channel.postMessage("back")}>
          Back
        </Button>
        <Button onClick={() => channel.postMessage("next")}>Next</Button>
      </p>
    </main>
  );
}
