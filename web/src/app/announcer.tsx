import { notifications } from "@mantine/notifications";
import { useEffect } from "react";
import { alarm, announce, useAnnouncements } from "../bench/announce";
import { eventTone } from "../bench/flag-words";
import { useBench } from "../stream/bench-store";

/** The page's live regions: faults, trips and a lost connection as alarms, findings politely. */
export function Announcer() {
  const { polite, alarm: loud } = useAnnouncements();
  const event = useBench((s) => s.events.at(-1));
  const blind = useBench((s) => s.blind);
  const notice = useBench((s) => s.notice);
  const phase = useBench((s) => s.connection.phase);
  const quiet = useBench((s) => s.connection.reason?.quiet ?? false);

  useEffect(() => {
    if (!blind) return;
    announce(""); // what was said last may tell a verdict
    alarm("");
  }, [blind]);

  useEffect(() => {
    if (!event) return;
    const tone = eventTone(event);
    if (tone === "alarm") alarm(event.text);
    if (tone === "found") announce(event.text);
  }, [event]);

  useEffect(() => {
    if (quiet) return;
    if (phase === "waiting") alarm("Connection lost, trying again.");
    if (phase === "closed") alarm("Not connected. The notice at the top says why.");
    if (phase === "open") announce("Connected.");
  }, [phase, quiet]);

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
