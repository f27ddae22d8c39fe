import createClient from "openapi-fetch";
import type { paths } from "./schema";
import { sessionHeaders } from "./session";
import type { ApiErrorBody } from "./types";

const OFFLINE: ApiErrorBody = { code: "offline", message: "The server does not answer.", field: "", hint: "" };

/** The server, typed by its own OpenAPI document; it is at the root of the page, which behind a proxy may be below a path. */
export const client = createClient<paths>({ baseUrl: ".", fetch: reach });

async function reach(request: Request): Promise<Response> {
  for (const [name, value] of Object.entries(sessionHeaders())) request.headers.set(name, value);
  try {
    return await fetch(request);
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

/** The data of an answer; a refusal becomes an `ApiError` with its reason and its advice. */
export async function data<T>(answer: Promise<{ data?: T; error?: unknown; response: Response }>): Promise<T> {
  const { data, error, response } = await answer;
  if (!response.ok) throw new ApiError(response.status, errorBody(error, response.status));
  return data as T;
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
