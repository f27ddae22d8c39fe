import "./jsdom-gaps"; // before a module of the page keeps what jsdom has
import "@testing-library/jest-dom/vitest";
import { cleanNotifications, cleanNotificationsQueue } from "@mantine/notifications";
import { notifyManager } from "@tanstack/react-query";
import { act, cleanup, configure } from "@testing-library/react";
import { afterEach, beforeEach, expect, vi } from "vitest";
import { queryClient } from "../api/queries";
import { stream } from "../stream/stream";
import { server } from "./fake-server";
import { resetScreen } from "./jsdom-gaps";
import { resetStores } from "./stores";

vi.mock("zustand", async (real) => {
  const zustand = await real<typeof import("zustand")>();
  return { ...zustand, create: (await import("./stores")).remembering(zustand.create) };
});

// a state is awaited as long as a busy machine may take
configure({ asyncUtilTimeout: 20_000 });
// an answer that comes between two lines of a test changes the view all the same
notifyManager.setNotifyFunction((notify) => act(notify));
// testing-library moves the clock of a test only where it finds one of jest's
Object.assign(globalThis, { jest: { advanceTimersByTime: (ms: number) => vi.advanceTimersByTime(ms) } });

document.head.innerHTML = '<base href="/" />'; // as the page has it

beforeEach(() => {
  vi.stubGlobal("fetch", server.fetch);
  server.on("POST", "/qr", { image: "data:," });
  vi.spyOn(console, "error").mockImplementation(() => undefined);
});

/** The page is gone, the next test finds all as this one did, and nothing has failed unseen. */
afterEach(async () => {
  cleanup();
  await act(async () => stream?.close()); // commands without an answer are refused
  cleanNotifications();
  cleanNotificationsQueue();
  queryClient.clear();
  resetStores();
  resetScreen();
  localStorage.clear();
  sessionStorage.clear();
  window.history.replaceState(null, "", "/");
  const errors = vi.mocked(console.error).mock.calls.map((call) => call.map(String).join(" "));
  const { unprepared } = server;
  server.reset();
  vi.useRealTimers();
  vi.unstubAllGlobals();
  vi.restoreAllMocks();
  expect(unprepared, "requests that no answer was prepared for").toEqual([]);
  expect(errors, "calls of console.error; a test that expects some clears them").toEqual([]);
});
