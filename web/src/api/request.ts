import { ApiError } from "./api-error";
import type { ApiErrorBody } from "./types";

const BASE = "/api/v1";

/** Ask the server; a refusal becomes an `ApiError` that says what happened and what to do. */
export async function request(path: string, init: RequestInit & { json?: unknown } = {}): Promise<Response> {
  const { json, ...rest } = init;
  const headers = json === undefined ? undefined : { "content-type": "application/json" };
  const body = json === undefined ? undefined : JSON.stringify(json);
  let response: Response;
  try {
    response = await fetch(BASE + path, { headers, body, ...rest });
  } catch {
    throw new ApiError(0, { code: "offline", message: "The server does not answer.", field: "", hint: "" });
  }
  if (!response.ok) throw new ApiError(response.status, await errorBody(response));
  return response;
}

async function errorBody(response: Response): Promise<ApiErrorBody> {
  try {
    const { error } = (await response.json()) as { error: ApiErrorBody };
    if (error?.message) return error;
  } catch {
    // Not our error shape: a proxy or a crash. The status is all there is.
  }
  return { code: "unexpected", message: `The server answered ${response.status}.`, field: "", hint: "" };
}
