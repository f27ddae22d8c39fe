import { create } from "zustand";

/** The texts for screen readers: news politely, alarms at once. */
export const useAnnouncements = create<{ polite: string; alarm: string }>(() => ({ polite: "", alarm: "" }));

export function announce(text: string): void {
  useAnnouncements.setState({ polite: text });
}

export function alarm(text: string): void {
  useAnnouncements.setState({ alarm: text });
}
