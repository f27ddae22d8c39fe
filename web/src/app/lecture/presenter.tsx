import { Box, Button, Group } from "@mantine/core";
import { type ReactNode, useEffect, useState } from "react";
import { lectures } from "../../api/lectures";
import { useAsked } from "../../api/queries";
import { storageName } from "../../api/storage-name";
import type { Cue, Lecture } from "../../api/types";
import { plannedTo, useLecture } from "../../bench/lecture";
import { EmptyState } from "../../ui/empty-state";
import { useTitle } from "../../ui/use-title";
import styles from "./lecture.module.css";
import { LECTURE_KEYS } from "./lecture-keys";
import { ClockFace, Notes, useMinutesSince } from "./notes";

const CHANNEL = storageName("combbench.lecture");
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

/** What follows the lecture of another window, in the place of the id of a lecture. */
const RUNNING = "1";

const notesAsked = (): string => new URLSearchParams(window.location.search).get(PARAMETER) || RUNNING;

/** Whether this window belongs to the speaker. */
export const isPresenter = (): boolean => new URLSearchParams(window.location.search).has(PARAMETER);

export const openPresenter = () =>
  void window.open(`./?${PARAMETER}=${RUNNING}`, "combbench-notes", "popup,width=720,height=620");

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

const told = (): Told => toldOf(useLecture.getState());

function toldOf({ lecture, at, began }: { lecture: Lecture | undefined; at: number; began: number }): Told {
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

/** The notes in large letters: of the lecture that runs in another window, or of a lecture by itself, as on a phone. */
export function Presenter() {
  const [asked] = useState(notesAsked);
  useTitle("Notes of the speaker");
  return asked === RUNNING ? <Following /> : <Alone id={asked} />;
}

/** The window of the speaker, on a screen that the audience does not see. */
function Following() {
  const [now, setNow] = useState<Told | undefined>(undefined);
  const [channel] = useState(() => new BroadcastChannel(CHANNEL));
  useEffect(() => {
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
        <p>Begin one in the window of the bench; the notes appear here. Gallery has the notes of every lecture.</p>
      </main>
    );
  return (
    <Page now={now} turn={(by) => channel.postMessage({ key: by > 0 ? "PageDown" : "PageUp" })}>
      <Group component="p" className="note" gap="0 16px">
        {LECTURE_KEYS.map(({ shown, does }) => (
          <span key={shown}>
            <kbd>{shown}</kbd> {does}
          </span>
        ))}
      </Group>
    </Page>
  );
}

/** The notes of a lecture that runs elsewhere or not at all; they turn by their own buttons. */
function Alone({ id }: { id: string }) {
  const { answer: lecture, refusal } = useAsked(["lecture", id], () => lectures.get(id));
  const [at, setAt] = useState(0);
  const [began] = useState(Date.now);
  if (refusal) return <EmptyState title="No notes">{refusal.message}</EmptyState>;
  if (!lecture) return null;
  const turn = (by: number) => setAt(Math.max(0, Math.min(lecture.script.length - 1, at + by)));
  return (
    <Page now={toldOf({ lecture, at, began })} turn={turn}>
      <p className="note">These notes turn by hand; the bench does not follow.</p>
    </Page>
  );
}

interface PageProps {
  now: Told;
  turn(by: 1 | -1): void;
  children: ReactNode;
}

function Page({ now, turn, children }: PageProps) {
  const used = useMinutesSince(now.began);
  return (
    <main className={`column ${styles.presenter}`}>
      <h1>
        <Box component="span" c="dimmed" fw={400}>
          {now.place}
        </Box>{" "}
        {now.cue?.title}
      </h1>
      <ClockFace used={used} planned={now.planned} whole={now.whole} />
      {now.cue && <Notes cue={now.cue} next={now.next} />}
      <Group gap={10}>
        <Button size="sm" onClick={() => turn(-1)}>
          Back
        </Button>
        <Button variant="filled" size="sm" onClick={() => turn(1)}>
          Next
        </Button>
      </Group>
      {children}
    </main>
  );
}
