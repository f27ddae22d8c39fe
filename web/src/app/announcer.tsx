import { notifications } from "@mantine/notifications";
import { useEffect } from "react";
import { alarm, announce, useAnnouncements } from "../bench/announce";
import { eventTone } from "../bench/flag-words";
import { useNarrator } from "../bench/narrator";
import { useBench } from "../stream/bench-store";
import { useBoardState, useStaleSince } from "../stream/freshness";
import { moreText, useCaption } from "./use-caption";

/** Events that the narrator says. */
const SAID = new Set(["inject", "recognised"]);

/** The page's live regions: faults, trips and a lost connection as alarms, findings politely. */
export function Announcer() {
  const { polite, alarm: loud } = useAnnouncements();
  const narrates = useNarrator((s) => s.on);
  const caption = useCaption();
  const event = useBench((s) => s.events.at(-1));
  const blind = useBench((s) => s.blind);
  const notice = useBench((s) => s.notice);
  const known = useBoardState() !== undefined;
  const stale = useStaleSince() !== undefined;

  useEffect(() => {
    if (!blind) return;
    announce(""); // the last announcement may name a verdict
    alarm("");
  }, [blind]);

  useEffect(() => {
    if (!event) return;
    if (narrates && SAID.has(event.kind)) return;
    const tone = eventTone(event);
    if (tone === "alarm") alarm(event.text);
    if (tone === "found") announce(event.text);
  }, [event, narrates]);

  useEffect(() => {
    if (!caption || !narrates || caption.sentence.kind === "trip") return; // a trip is an alarm already
    announce(caption.more ? `${moreText(caption.more)} ${caption.sentence.text}` : caption.sentence.text);
  }, [caption, narrates]);

  useEffect(() => {
    if (stale) alarm("The page is not connected: its values are old. The notice at the top says why.");
    else if (known) announce("Connected.");
  }, [known, stale]);

  useEffect(() => {
    if (!notice || notice.code === "slow_client") return; // the header says that one, without covering anything
    notifications.show({ id: `notice-${notice.code}`, message: notice.message, autoClose: 5000 });
  }, [notice]);

  return (
    <>
      <div className="visually-hidden" role="status" aria-live="polite">
        {polite}
      </div>
      <div className="visually-hidden" role="alert" aria-live="assertive">
        {loud}
      </div>
    </>
  );
}
