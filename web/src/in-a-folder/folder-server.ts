import type { Bench } from "../api/types";
import { FileBench } from "../in-a-file/file-bench";
import type { FileDocument } from "../in-a-file/file-document";
import type { ClientMessage } from "../stream/wire";
import { FolderChannel, refusalOf } from "./folder-channel";
import { LiveBench } from "./live-bench";
import type { FromWorker, ToWorker } from "./messages";
import { traceOf } from "./trace";

const GONE = 4404;
/** A worker that begins anew is another server. */
const SERVER = `${performance.timeOrigin}`;
/** Benches at a time; each has a history of its own. */
const MOST = 6;

/** The answers of a server that were recorded with the bench. */
export interface FolderAnswers {
  bench: Bench;
  catalog: unknown[];
  scenario: { id: string; title: string };
  devices: unknown[];
  printed: unknown[];
  drawing: { title: string; geometry: object | null } | null;
  stand_in: { title: string; geometry: object | null } | null;
}

type Question = Extract<ToWorker, { ask: number }>;

interface Answer {
  status: number;
  body: unknown;
}

const found = (body: unknown): Answer => ({ status: 200, body });

/** In place of a server: one scenario, its benches and their streams. It keeps nothing. */
export class FolderServer {
  private readonly code: BufferSource;
  private readonly document: FileDocument;
  private readonly answers: FolderAnswers;
  private readonly post: (message: FromWorker, moved?: Transferable[]) => void;
  private readonly benches = new Map<string, LiveBench>();
  private readonly channels = new Map<number, FolderChannel>();
  private made = 0;
  private sought = 0;

  constructor(
    code: BufferSource,
    document: FileDocument,
    answers: FolderAnswers,
    post: (message: FromWorker, moved?: Transferable[]) => void,
  ) {
    this.code = code;
    this.document = document;
    this.answers = answers;
    this.post = post;
  }

  /** Begin with a bench. */
  async begin(): Promise<void> {
    (await this.make()).begin();
  }

  /** Run the ticks that are due, and send the news. */
  turn(now: number): void {
    for (const bench of this.benches.values()) bench.turn(now);
    for (const channel of this.channels.values()) channel.flush(now);
  }

  /** Hear a message of the page. */
  async hear(message: ToWorker): Promise<void> {
    if ("ask" in message) {
      const { status, body } = await this.answer(message).catch((error: Error) => ({
        status: 409,
        body: { error: refusalOf(error) },
      }));
      this.post({ ask: message.ask, status, body });
    } else if ("open" in message) this.open(message.channel, message.open);
    else if ("text" in message) this.channels.get(message.channel)?.hear(JSON.parse(message.text) as ClientMessage);
    else this.channels.delete(message.channel);
  }

  private open(channel: number, id: string): void {
    const bench = this.benches.get(id);
    this.post(bench ? { channel, opened: true } : { channel, closed: GONE });
    if (!bench) return;
    const post = (data: string | ArrayBuffer) => this.post({ channel, data }, typeof data === "string" ? [] : [data]);
    this.channels.set(channel, new FolderChannel(bench, SERVER, (one) => this.benches.get(one), post));
  }

  private async answer({ method, path, query, body }: Question): Promise<Answer> {
    const { answers } = this;
    const [what, id, deed] = path.split("/").slice(1);
    if (what === "benches" && id !== undefined)
      return this.ofBench(method, id, deed ?? "", body, new URLSearchParams(query));
    const known: Record<string, () => unknown> = {
      "GET /me": () => ({ id: "reader", role: "reader", name: "", bench: null, hand: false }),
      "GET /catalog": () => ({ version: this.document.version, blocks: answers.catalog }),
      "GET /scenarios": () => ({ scenarios: [answers.scenario] }),
      "GET /devices": () => ({ devices: answers.devices, geometry: [] }),
      "POST /devices/evaluate": () => this.drawing((body.device ?? {}) as { id?: string }),
      "GET /benches": () => ({ benches: [...this.benches.values()].map((bench) => bench.describe()) }),
    };
    const recorded = known[`${method} ${path}`];
    if (recorded) return found(recorded());
    if (method === "POST" && path === "/benches") return { status: 201, body: await this.again() };
    return absent();
  }

  private async ofBench(
    method: string,
    id: string,
    deed: string,
    body: Question["body"],
    query: URLSearchParams,
  ): Promise<Answer> {
    const bench = this.benches.get(id);
    if (!bench)
      return { status: 404, body: { error: { ...refusalOf(new Error("this bench is closed")), code: "not_found" } } };
    if (method === "DELETE" && deed === "") {
      this.close(id);
      return { status: 204, body: null };
    }
    if (method === "PATCH") bench.name = String(body.name);
    if (deed === "" || deed === "reopen") return found(bench.describe());
    if (deed === "events") return found({ events: bench.events, last: bench.lastEvent, lost: 0 });
    if (deed === "printed") return found({ marks: this.answers.printed });
    if (deed === "trace") return found(traceOf(bench.file, query));
    if (deed === "fork") return { status: 201, body: await this.fork(bench, body) };
    if (deed !== "commands") return absent();
    if (body.kind === "seek") await this.seek(bench, Number(body.tick));
    else bench.execute(body as never);
    const entry = bench.events[bench.events.length - 1];
    return found({ tick: entry.tick, time_ms: entry.tick * this.document.dt_ms, entry });
  }

  /** Make a bench that continues from a tick of the past of another, or from now. */
  private async fork(
    of: LiveBench,
    { tick, before, window_ticks, paused, name }: Record<string, unknown>,
  ): Promise<Bench> {
    const made = await this.make(of.time.scale);
    const at = typeof tick === "number" ? tick : of.file.tick;
    if (at > of.file.tick || at < of.track.first) throw new Error(`tick ${at} is not kept`);
    made.takeOver(of);
    if (typeof tick === "number") made.origin = { bench: of.id, tick: at, window_ticks: Number(window_ticks) };
    made.stand(of, at, Number(window_ticks ?? 0), before === true);
    made.name = String(name ?? "");
    made.time.isRunning = !paused && of.time.isRunning;
    return made.describe();
  }

  /** Let a bench that shows the past show another tick; of several asked for at once, the last. */
  private async seek(bench: LiveBench, tick: number): Promise<void> {
    this.sought += 1;
    const { sought } = this;
    await new Promise((resolve) => setTimeout(resolve));
    if (sought !== this.sought) throw new Error("another moment is sought by now");
    const { origin } = bench;
    if (!origin || !bench.isPast) throw new Error("it has gone on from its past");
    bench.origin = { ...origin, tick };
    bench.stand(this.benches.get(origin.bench) ?? bench, tick, origin.window_ticks);
  }

  /** The drawing of the device of the bench, or of the device that the page shows in its place. */
  private drawing({ id }: { id?: string }) {
    const { drawing, stand_in } = this.answers;
    return drawing?.geometry || id !== stand_in?.title ? drawing : stand_in;
  }

  /** The first bench from its start. */
  private async again(): Promise<Bench> {
    for (const id of [...this.benches.keys()]) this.close(id);
    this.made = 0;
    await this.begin();
    return [...this.benches.values()][0].describe();
  }

  private async make(scale?: number | null): Promise<LiveBench> {
    if (this.benches.size >= MOST) throw new Error(`${MOST} benches are open, as many as this page holds; remove one`);
    this.made += 1;
    const file = await FileBench.load(this.code, this.document);
    const { bench } = this.answers;
    const id = this.made === 1 ? bench.id : `${bench.id}-${this.made}`;
    const made = new LiveBench(id, file, bench, scale);
    this.benches.set(id, made);
    return made;
  }

  private close(id: string): void {
    this.benches.delete(id);
    for (const [channel, { bench }] of this.channels)
      if (bench.id === id) {
        this.channels.delete(channel);
        this.post({ channel, closed: GONE });
      }
  }
}

/** What only a server does. */
const absent = (): Answer => ({
  status: 404,
  body: { error: { code: "needs_server", message: "This page has no server, which that needs.", field: "", hint: "" } },
});
