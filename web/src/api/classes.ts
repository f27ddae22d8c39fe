import { at, client, data, every, rows } from "./client";
import type { Class, Command, Document, DrivingTurn, NewBench, NewClass, Tile } from "./types";

const ofClass = (class_id: string) => at({ class_id });
const ofBench = (bench_id: string) => at({ bench_id });

/** The REST calls around classes, and around links to watch a bench. */
export const classes = {
  all: () => every("classes", (query) => client.GET("/api/v1/classes", { params: { query } })),
  open: (body: NewClass) => data(client.POST("/api/v1/classes", { body })),
  end: (id: string) => data(client.DELETE("/api/v1/classes/{class_id}", ofClass(id))),
  newCode: (id: string, minutes: number) =>
    data(client.POST("/api/v1/classes/{class_id}/code", { ...ofClass(id), body: { minutes } })),
  closeJoining: (id: string) => data(client.DELETE("/api/v1/classes/{class_id}/code", ofClass(id))),
  members: (class_id: string) =>
    every("members", (query) => client.GET("/api/v1/classes/{class_id}/members", at({ class_id }, query))) as Promise<
      Tile[]
    >,
  sendAway: (class_id: string, member_id: string) =>
    data(client.DELETE("/api/v1/classes/{class_id}/members/{member_id}", at({ class_id, member_id }))),
  command: (id: string, command: Command, members: string[] | null) =>
    data(client.POST("/api/v1/classes/{class_id}/commands", { ...ofClass(id), body: { command, members } })),
  begin: (id: string, body: NewBench) =>
    data(client.POST("/api/v1/classes/{class_id}/scenario", { ...ofClass(id), body })),
  startTogether: (id: string, members: string[] | null) =>
    data(client.POST("/api/v1/classes/{class_id}/start", { ...ofClass(id), body: { members } })),
  show: (id: string, bench: string) =>
    data(client.PUT("/api/v1/classes/{class_id}/shown", { ...ofClass(id), body: { bench } })),
  endShowing: (id: string) => data(client.DELETE("/api/v1/classes/{class_id}/shown", ofClass(id))),
  giveLayout: (id: string, name: string, layout: Document | null) =>
    data(client.PUT("/api/v1/classes/{class_id}/layout", { ...ofClass(id), body: { name, layout } })),
  lowerHand: (class_id: string, member_id: string) =>
    data(client.DELETE("/api/v1/classes/{class_id}/members/{member_id}/hand", at({ class_id, member_id }))),
  /** Ask for a bench, hand it over, take it back; `to` is whom it concerns. */
  drive: (bench: string, what: DrivingTurn, to = "") =>
    data(client.POST("/api/v1/benches/{bench_id}/driving", { ...ofBench(bench), body: { do: what, to } })),
  benchAudit: (bench_id: string, most: number) =>
    rows("entries", (page) => client.GET("/api/v1/benches/{bench_id}/audit", at({ bench_id }, page)), most),
  audit: (class_id: string, most: number) =>
    rows("entries", (page) => client.GET("/api/v1/classes/{class_id}/audit", at({ class_id }, page)), most),
  watchers: (bench_id: string) =>
    every("watchers", (query) => client.GET("/api/v1/benches/{bench_id}/watchers", at({ bench_id }, query))),
  /** Let people without the access token watch a bench by a link that was shared. */
  letWatch: (bench: string, link: string, hours: number) =>
    data(client.POST("/api/v1/benches/{bench_id}/watchers", { ...ofBench(bench), body: { hours, link } })),
  endWatching: (bench_id: string, watcher_id: string) =>
    data(client.DELETE("/api/v1/benches/{bench_id}/watchers/{watcher_id}", at({ bench_id, watcher_id }))),
};

/** The full address at which students join; undefined while joining is closed. */
export function joinAddress({ path, addresses }: Pick<Class, "path"> & { addresses?: string[] }): string | undefined {
  if (addresses?.[0]) return addresses[0];
  return path ? new URL(`.${path}`, document.baseURI).href : undefined;
}

const LOCAL = /^(localhost|127(\.\d+){3}|\[::1\])$/;

/** Whether an address is for this machine alone. */
export const isLocal = (address: string): boolean => LOCAL.test(new URL(address).hostname);
