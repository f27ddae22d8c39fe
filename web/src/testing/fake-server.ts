import type { ApiErrorBody } from "../api/types";

/** A request as a test reads it: the path is that below `/api/v1`, where it is below. */
export interface Asked {
  method: string;
  path: string;
  /** A name that is repeated has its values with commas between them. */
  query: Record<string, string>;
  body: unknown;
  /** Parts of the path by the `:name` of the route. */
  params: Record<string, string>;
}

type Answer = unknown | ((asked: Asked) => unknown);

interface Route {
  method: string;
  pattern: RegExp;
  answer: Answer;
}

const API = /^\/api\/v1(?=\/)/;

/** The server of a test, in place of `fetch`: it gives the answers that the test prepares, and remembers each request. */
class FakeServer {
  /** Every request, the oldest first. */
  requests: Asked[] = [];
  /** Requests without an answer, which fail the test. */
  unprepared: string[] = [];
  private routes: Route[] = [];

  /**
   * Prepare an answer, or how to make it; a later one for the same path replaces it. `undefined` is an answer without
   * content, a string is sent as it is, a `Refusal` is an error.
   *
   * @example server.on("GET", "/benches/:id/trace", ({ params }) => traces[params.id])
   */
  on(method: string, path: string, answer?: Answer): void {
    const pattern = new RegExp(`^${path.replace(/:(\w+)/g, "(?<$1>[^/]+)")}$`);
    this.routes.unshift({ method, pattern, answer });
  }

  /** The requests of a method to a path. */
  asked(method: string, path: string): Asked[] {
    return this.requests.filter((asked) => asked.method === method && asked.path === path);
  }

  reset(): void {
    this.requests = [];
    this.unprepared = [];
    this.routes = [];
  }

  /** Stands in for `fetch`. */
  readonly fetch = async (input: RequestInfo | URL, init?: RequestInit): Promise<Response> => {
    const request = new Request(input, init);
    const url = new URL(request.url);
    const { method } = request;
    const path = url.pathname.replace(API, "");
    const text = await request.text();
    const asked = { method, path, query: queryOf(url), body: parsed(text), params: {} };
    this.requests.push(asked);
    const route = this.routes.find((one) => one.method === method && one.pattern.test(path));
    if (!route) {
      this.unprepared.push(`${method} ${path}`);
      throw new TypeError(`nothing is prepared for ${method} ${path}`);
    }
    const params = { ...route.pattern.exec(path)?.groups };
    const { answer } = route;
    return responseOf(typeof answer === "function" ? await answer({ ...asked, params }) : answer);
  };
}

/** An answer that is an error, in the shape that all errors of the server have. */
export class Refusal {
  readonly status: number;
  readonly error: ApiErrorBody;

  constructor(status: number, message: string, rest: Partial<ApiErrorBody> = {}) {
    this.status = status;
    this.error = { code: "refused", message, field: "", hint: "", ...rest };
  }
}

/** The one server of a test; empty again for the next. */
export const server = new FakeServer();

const queryOf = ({ searchParams }: URL): Record<string, string> =>
  Object.fromEntries([...searchParams.keys()].map((name) => [name, searchParams.getAll(name).join()]));

function parsed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return text || undefined;
  }
}

function responseOf(answer: unknown): Response {
  if (answer instanceof Response) return answer;
  if (answer instanceof Refusal) return Response.json({ error: answer.error }, { status: answer.status });
  if (answer === undefined) return new Response(null, { status: 204 });
  return typeof answer === "string" ? new Response(answer) : Response.json(answer);
}
