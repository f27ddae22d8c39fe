import { Button } from "@mantine/core";
import { useEffect, useState } from "react";
import type { Cue } from "../../api/types";
import { plannedTo, useLecture } from "../../bench/lecture";
import styles from "./lecture.module.css";
import { LECTURE_KEYS } from "./lecture-keys";
import { ClockFace, Notes, useMinutesSince } from "./notes";

const CHANNEL = "combbench.lecture";
const PARAMETER = "notes";

/** The place of the lecture, for the window of the speaker. */
interface Told {
  cue: Cue | undefined;
  next: string | undefined;
  place: string;
  began: number;
  planned: number;
  whole: number;
}
/** A key of the lecture, or nothing but where it is. */
interface Asked {
  key?: string;
}
type Message = Told | Asked;

const isAsked = (message: Message): message is Asked => !("place" in message);

/** Whether this window is that of the speaker. */
export const isPresenter = (): boolean => new URLSearchParams(window.location.search).get(PARAMETER) === "1";

export const openPresenter = () =>
  void window.open(`./?${PARAMETER}=1`, "combbench-notes", "popup,width=720,height=620");

/** Send the place of the lecture to the window of the speaker, if there is one, and run the keys that are pressed there. */
export function usePresenter(): void {
  const runs = useLecture((s) => s.lecture !== undefined);
  useEffect(() => {
    if (!runs) return;
    const channel = new BroadcastChannel(CHANNEL);
    const tell = () => channel.postMessage(told());
    channel.onmessage = ({ data }: MessageEvent<Message>) => {
      if (!isAsked(data)) return;
      const binding = LECTURE_KEYS.find(({ key }) => key === data.key);
      if (binding) binding.run();
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

/** The window of the speaker: the notes in large letters, on a screen that the audience does not see. */
export function Presenter() {
  const [now, setNow] = useState<Told | undefined>(undefined);
  const [channel] = useState(() => new BroadcastChannel(CHANNEL));
  const used = useMinutesSince(now?.began ?? 0);
  useEffect(() => {
    document.title = "Notes of the speaker";
    channel.onmessage = ({ data }: MessageEvent<Message>) => !isAsked(data) && setNow(data);
    const press = (event: KeyboardEvent) => {
      const { key, target } = event;
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (!LECTURE_KEYS.some((one) => one.key === key)) return;
      if (key === " " && (target as HTMLElement).closest("button")) return;
      event.preventDefault();
      channel.postMessage({ key });
    };
    window.addEventListener("keydown", press);
    channel.postMessage({});
    return () => window.removeEventListener("keydown", press);
  }, [channel]);
  if (!now?.cue)
    return (
      <main className={`column ${styles.presenter}`}>
        <h1>No lecture runs</h1>
        <p>Begin one in the window of the bench; the notes appear here.</p>
      </main>
    );
  return (
    <main className={`column ${styles.presenter}`}>
      <h1>
        <span>{now.place}</span> {now.cue.title}
      </h1>
      <ClockFace used={used} planned={now.planned} whole={now.whole} />
      <Notes cue={now.cue} next={now.next} />
      <p className={`row ${styles.bar}`}>
        <Button size="sm" onClick={() => channel.postMessage({ key: "PageUp" })}>
          Back
        </Button>
        <Button variant="filled" size="sm" onClick={() => channel.postMessage({ key: "PageDown" })}>
          Next
        </Button>
      </p>
      <p className={styles.keys}>
        {LECTURE_KEYS.map(({ shown, does }) => (
          <span key={shown}>
            <kbd>{shown}</kbd> {does}{" "}
          </span>
        ))}
      </p>
    </main>
  );
}
