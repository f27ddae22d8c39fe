import type { ApiErrorBody } from "./types";

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
