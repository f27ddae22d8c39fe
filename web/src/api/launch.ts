import { ApiError } from "./client";
import { isInFrame, keepSession, sessionHeaders } from "./session";
import type { ApiErrorBody } from "./types";

const AGAIN = "Open the exercise again from your course.";

/** An address that the browser loads without the page; where there is no cookie it gets a ticket, which works once. */
export async function ticketed(address: string): Promise<string> {
  if (!isInFrame()) return address;
  const url = new URL(address, document.baseURI);
  const path = url.pathname.slice(new URL("./", document.baseURI).pathname.length - 1);
  const { ticket } = await ask<{ ticket: string }>("./lti/ticket", { path });
  url.searchParams.set("ticket", ticket);
  return url.href;
}

/** Exchange the launch code in the address for a session. A page that is in no frame gets a cookie, and begins again. */
export async function launch(): Promise<void> {
  if (!window.location.pathname.endsWith("/lti")) return;
  const given = new URLSearchParams(window.location.hash.slice(1));
  window.history.replaceState(null, "", window.location.pathname + window.location.search);
  const framed = window.top !== window.self;
  const code = given.get("launch");
  if (!code) throw new ApiError(403, refusal("This page was opened without a launch."));
  const name = `combbench.lti.${given.get("state")}`;
  const browser = window.sessionStorage.getItem(name) ?? "";
  window.sessionStorage.removeItem(name);
  const made = await ask<{ session: string | null }>("./lti/session", { code, browser, framed });
  if (!made.session) {
    window.location.replace(`./${window.location.search}`);
    return new Promise(() => {}); // the page that begins now ends here
  }
  keepSession(made.session);
  window.addEventListener("click", follow, { capture: true });
  window.addEventListener("error", loadAgain, { capture: true });
}

async function ask<T>(path: string, body: object): Promise<T> {
  const headers = { "Content-Type": "application/json", ...sessionHeaders() };
  const answer = await fetch(path, { method: "POST", headers, body: JSON.stringify(body) }).catch(() => undefined);
  if (answer?.ok) return (await answer.json()) as T;
  const { error } = ((await answer?.json().catch(() => undefined)) ?? {}) as { error?: ApiErrorBody };
  throw new ApiError(answer?.status ?? 0, error ?? refusal("The server does not answer."));
}

const refusal = (message: string): ApiErrorBody => ({ code: "lti_refused", message, field: "", hint: AGAIN });

/** Whether an address is one of those for which the server wants a session. */
const isKept = (address: string): boolean =>
  new URL(address, document.baseURI).pathname.startsWith(new URL("./api/", document.baseURI).pathname);

/** A link to a file of the server gets its ticket at the click. */
function follow(event: MouseEvent): void {
  const link = (event.target as Element | null)?.closest?.("a");
  if (!link || !isKept(link.href)) return;
  event.preventDefault();
  const other = link.target === "_blank" ? window.open("about:blank") : window;
  ticketed(link.href).then((address) => other?.location.assign(address));
}

/** A picture of the server is refused without a ticket; with one it comes. */
function loadAgain(event: Event): void {
  const picture = event.target;
  if (!(picture instanceof HTMLImageElement) || !isKept(picture.src) || picture.src.includes("ticket=")) return;
  ticketed(picture.src).then((address) => {
    picture.src = address;
  });
}
