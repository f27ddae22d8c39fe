import createClient from "openapi-fetch";
import type { paths } from "./schema";
import { sessionHeaders } from "./session";
import type { ApiErrorBody } from "./types";

const OFFLINE: ApiErrorBody = { code: "offline", message: "The server does not answer.", field: "", hint: "" };

/** What answers the calls of the page: the network, or a worker that has it in place of a server. */
let answering: (request: Request) => Promise<Response> = (request) => fetch(request);

/** Let something else answer from now on. */
export const setAnswering = (other: typeof answering): void => {
  answering = other;
};

/** The server, typed by its own OpenAPI document; it is at the root of the page, which behind a proxy may be below a path. */
export const client = createClient<paths>({ baseUrl: ".", fetch: reach });

async function reach(request: Request): Promise<Response> {
  for (const [name, value] of Object.entries(sessionHeaders())) request.headers.set(name, value);
  try {
    return await answering(request);
  } catch {
    throw new ApiError(0, OFFLINE);
  }
}

/** The parameters of a call: of its path, and of its query. */
export function at<P>(path: P): { params: { path: P } };
export function at<P, Q>(path: P, query: Q): { params: { path: P; query: Q } };
export function at(path: unknown, query?: unknown) {
  return { params: { path, query } };
}

type Answer<T> = Promise<{ data?: T; error?: unknown; response: Response }>;

/** The data of an answer; a refusal becomes an `ApiError` with its reason and its advice. */
export async function data<T>(answer: Answer<T>): Promise<T> {
  const { data, error, response } = await answer;
  if (!response.ok) throw new ApiError(response.status, errorBody(error, response.status));
  return data as T;
}

/** Which page of a list is asked for. */
interface PageQuery {
  limit: number;
  after?: string;
}

/** Rows from the beginning of a list. */
export interface Rows<R> {
  rows: R[];
  /** Whether the list has no further rows. */
  isWhole: boolean;
}

const PAGE = 1000;

/** The rows under a name in the answers of a list, page by page until there are enough. */
export async function rows<K extends string, R>(
  name: K,
  ask: (query: PageQuery) => Answer<Record<K, R[]>>,
  most = Number.POSITIVE_INFINITY,
): Promise<Rows<R>> {
  const found: R[] = [];
  let after: string | undefined;
  do {
    const answer = ask({ limit: Math.min(most, PAGE), after });
    found.push(...(await data(answer))[name]);
    after = nextCursor((await answer).response);
  } while (after !== undefined && found.length < most);
  return { rows: found, isWhole: after === undefined };
}

/** All rows under a name in the answers of a list. */
export const every = async <K extends string, R>(
  name: K,
  ask: (query: PageQuery) => Answer<Record<K, R[]>>,
): Promise<R[]> => (await rows(name, ask)).rows;

function nextCursor({ headers }: Response): string | undefined {
  const address = /<([^>]*)>; rel="next"/.exec(headers.get("Link") ?? "")?.[1];
  return address === undefined ? undefined : (new URL(address).searchParams.get("after") ?? undefined);
}

/** A proxy or a crash may answer in another shape; then the status is all there is. */
function errorBody(error: unknown, status: number): ApiErrorBody {
  const body = (error as { error?: ApiErrorBody } | undefined)?.error;
  if (body?.message) return { ...body, hint: body.hint ?? "" };
  return { code: "unexpected", message: `The server answered ${status}.`, field: "", hint: "" };
}

/** A refusal by the server, with the field it concerns and what to do about it. */
export class ApiError extends Error {
  readonly status: number;
  readonly body: ApiErrorBody;

  constructor(status: number, body: ApiErrorBody) {
    super(body.message);
    this.status = status;
    this.body = body;
  }
}

/** For `catch`: an answer with this status is no failure. */
export const unless =
  (status: number) =>
  (error: unknown): undefined => {
    if (!(error instanceof ApiError && error.status === status)) throw error;
  };
