export interface CloseReason {
  /** Whether trying again by itself can help. */
  retry?: boolean;
  /** The offer of the page when it cannot reconnect by itself. */
  offer?: "bench" | "reload" | "login";
  /** Not worth a notice: the page reconnects, and its header says that it is slow. */
  quiet?: boolean;
  title: string;
  advice: string;
}

const REASONS: Record<number, CloseReason> = {
  4001: {
    offer: "reload",
    title: "The server speaks a newer version",
    advice: "Reload the page to get the matching one.",
  },
  4003: {
    title: "This address may not open the bench",
    advice: "Open the page at the address the server printed.",
  },
  4205: {
    retry: true,
    quiet: true,
    title: "The visible part of this bench has changed",
    advice: "Reconnecting.",
  },
  4401: {
    offer: "login",
    title: "You are not logged in",
    advice: "Open the address with the token that the server printed when it started.",
  },
  4403: {
    offer: "bench",
    title: "This bench is not yours",
    advice: "Another bench replaced it, or it belongs to another person.",
  },
  4404: {
    offer: "bench",
    title: "This bench was closed",
    advice: "It was closed, or the server was restarted: benches live as long as the server runs.",
  },
  4408: {
    retry: true,
    quiet: true,
    title: "This page fell too far behind",
    advice: "Close panels you do not need; reconnecting.",
  },
  1008: { retry: true, title: "Too many messages from this page", advice: "Reconnecting." },
  1009: { retry: true, title: "A message was too big", advice: "Reconnecting." },
  1013: { retry: true, title: "The server has no room for another watcher", advice: "Trying again." },
};

const LOST: CloseReason = {
  retry: true,
  title: "Connection lost",
  advice: "The page reconnects by itself; the simulation keeps running.",
};

/** The meaning of a WebSocket close code for the person at the page. */
export function closeReason(code: number): CloseReason {
  return REASONS[code] ?? LOST;
}
