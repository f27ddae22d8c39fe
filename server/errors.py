"""One error shape for everything the service refuses."""

from __future__ import annotations

import errno
import logging
from collections.abc import Iterable, Mapping, Sequence
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel, field_validator
from sqlalchemy.exc import DBAPIError
from starlette.exceptions import HTTPException
from starlette.routing import Match
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocketDisconnect

from core.errors import InputError, did_you_mean, either, field_of, one_line
from core.format import micro
from scenarios.arrow import pa

log = logging.getLogger(__name__)

LONGEST = 300
"""Characters of a message, a field or a hint: one line a person reads."""
METHODS = ("DELETE", "GET", "PATCH", "POST", "PUT")
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
STORAGE = "the database cannot be used now; the log says why"


class ErrorBody(BaseModel):
    """An error: one line, the field at fault, a hint."""

    code: str
    message: str
    field: str = ""
    hint: str = ""

    @field_validator("message", "field", "hint")
    @classmethod
    def _in_one_line(cls, text: str) -> str:
        """Shorten the text, and keep it in one line: it may quote a caller, or list all allowed values."""
        text = micro(one_line(text[: LONGEST + 1]))
        return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"


class ErrorReply(BaseModel):
    """The one error shape of every answer."""

    error: ErrorBody


class ApiError(HTTPException):
    """A refusal with its HTTP status.

    Parameters
    ----------
    status : int
        HTTP status.
    code : str
        Short word a program can test for.
    message : str
        One line for a person.
    field, hint : str
        The field at fault; what to do about it.
    headers : mapping, optional
        Further response headers.
    """

    def __init__(
        self,
        status: int,
        code: str,
        message: str,
        field: str = "",
        hint: str = "",
        headers: Mapping[str, str] | None = None,
    ) -> None:
        super().__init__(status, message, dict(headers or {}))
        self.body = ErrorBody(code=code, message=message, field=field, hint=hint)


def not_found(noun: str, name: str, hint: str = "", field: str = "", known: Iterable[str] = ()) -> ApiError:
    """Refuse an unknown name; the nearest that is known is better advice than any other."""
    return ApiError(404, "not_found", f"there is no {noun} '{name}'", field, did_you_mean(name, known) or hint)


def body_of(error: Exception) -> ErrorBody:
    """Return a refusal of any kind as an error body."""
    if isinstance(error, ApiError):
        return error.body
    if isinstance(error, InputError):
        return ErrorBody(**error.as_dict())
    raise TypeError(f"not a refusal: {error!r}")


def reply(status: int, body: ErrorBody, headers: Mapping[str, str] | None = None) -> JSONResponse:
    """Build the error response."""
    return JSONResponse(ErrorReply(error=body).model_dump(), status, headers=dict(headers or {}))


def clear_line(errors: Sequence[Any]) -> ErrorBody:
    """Put the first of pydantic's complaints into one line.

    Parameters
    ----------
    errors : sequence of dict
        ``ValidationError.errors()``.
    """
    first = errors[0]
    kind = str(first["type"])
    if kind == "json_invalid":
        reason = first.get("ctx", {}).get("error", first["msg"])
        return ErrorBody(code="malformed", message=f"the body is not valid JSON: {reason}")
    cause = first.get("ctx", {}).get("error")
    if isinstance(cause, InputError):
        return body_of(cause)
    where = [part for part in first["loc"] if part not in ("body", "query", "path")]
    field = field_of({**first, "loc": where})
    code = "unknown_field" if kind == "extra_forbidden" else "invalid"
    if not field and kind in ("missing", "model_attributes_type", "dict_type"):
        hint = "send JSON with the header Content-Type: application/json"
        return ErrorBody(code=code, message="the body must be a JSON object", hint=hint)
    reasons = (_reason(complaint) for complaint in errors if field_of(complaint) == field_of(first))
    reason = either(reasons, "should be") + _given(first)
    return ErrorBody(code=code, message=f"{field or 'body'}: {reason}", field=field)


def _reason(error: Any) -> str:
    """Put one pydantic complaint into words."""
    kind = str(error["type"])
    if kind == "extra_forbidden":
        return "unknown field"
    if kind == "missing":
        return "is required"
    if kind.startswith("union_tag"):
        context = error.get("ctx", {})
        allowed = context.get("expected_tags")
        tag = context.get("discriminator", "kind")
        return f"needs {tag} to be one of {allowed}" if allowed else f"needs {tag}"
    return str(error["msg"]).removeprefix("Input ").removeprefix("Value error, ")


def _given(error: Any) -> str:
    """Quote the given value, if it is short and not the name of a field."""
    kind, given = str(error["type"]), error.get("input")
    if kind in ("extra_forbidden", "missing") or kind.startswith("union_tag"):
        return ""
    if isinstance(given, bool | int | float):
        return f" (got {given})"
    return f" (got {given!r})" if isinstance(given, str) and len(given) <= 40 else ""


REFUSED = (InputError, ApiError, DBAPIError)
"""Errors of one of several people; nothing has changed for that person then."""


def why(error: Exception) -> str:
    """Return the reason of a refusal in words; the cause of a failure of the database goes to the log alone."""
    if isinstance(error, DBAPIError):
        log.error("the database refused: %s", error.orig)
        return STORAGE
    return str(error)


def install(app: FastAPI) -> None:
    """Answer every failure of ``app`` in the one shape."""

    @app.exception_handler(ApiError)
    async def _(_request: Request, error: ApiError) -> JSONResponse:
        return reply(error.status_code, error.body, error.headers)

    @app.exception_handler(DBAPIError)
    async def _(_request: Request, error: DBAPIError) -> JSONResponse:
        log.error("the database refused: %s", error.orig)
        body = ErrorBody(code="storage", message=STORAGE)
        return reply(503, body, {"Retry-After": "5"})

    @app.exception_handler(OSError)
    async def _(_request: Request, error: OSError) -> JSONResponse:
        if error.errno is None:  # the reader of traces reports damaged files so
            return unreadable(error)
        if error.errno not in FULL:
            raise error
        log.error("no room to write: %s", error)
        body = ErrorBody(code="no_space", message=f"the answer cannot be made: {error.strerror}")
        return reply(507, body)

    @app.exception_handler(InputError)
    async def _(_request: Request, error: InputError) -> JSONResponse:
        return reply(422, body_of(error))

    @app.exception_handler(RequestValidationError)
    async def _(_request: Request, error: RequestValidationError) -> JSONResponse:
        body = clear_line(error.errors())
        return reply(400 if body.code == "malformed" else 422, body)

    @app.exception_handler(HTTPException)
    async def _(request: Request, error: HTTPException) -> JSONResponse:
        phrase = HTTPStatus(error.status_code).phrase
        code = phrase.lower().replace(" ", "_")
        message = f"{phrase.lower()}: {request.method} {request.url.path}"
        headers = dict(error.headers or {})
        if error.status_code == 405:
            headers["Allow"] = ", ".join(allowed(request))
        return reply(error.status_code, ErrorBody(code=code, message=message), headers)


def unreadable(error: Exception) -> JSONResponse:
    """Answer for a file that is damaged."""
    log.error("a file cannot be read: %s", error)
    body = ErrorBody(code="damaged", message="the file cannot be read: it is damaged", hint="the log says where")
    return reply(410, body)


def allowed(request: Request) -> list[str]:
    """Return the methods that a path allows over all its routes; the framework reports only one route."""
    routes = request.app.routes

    def leads(method: str) -> bool:
        scope = {**request.scope, "method": method}
        return any(route.matches(scope)[0] == Match.FULL for route in routes)

    return [method for method in METHODS if leads(method)]


class CatchAll:
    """Answers an unexpected error in the one shape; the log has the error itself.

    Parameters
    ----------
    app : ASGIApp
        The application to wrap.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the call on; after an error, answer 500 if no answer has begun."""
        started = False

        async def watched(message: Message) -> None:
            nonlocal started
            started = True
            try:
                await send(message)
            except (OSError, RuntimeError) as error:
                if scope["type"] != "websocket":
                    raise
                # The line is cut, or the web server has closed it because the client broke its rules.
                raise WebSocketDisconnect(1006) from error

        try:
            await self._app(scope, receive, watched)
        except WebSocketDisconnect as gone:
            log.info("a client of %s has gone before it was answered", scope["path"])
            if isinstance(gone.__cause__, OSError):
                raise gone.__cause__ from None  # so that the web server does not miss the answer
        except Exception as error:
            can_answer = scope["type"] == "http" and not started
            if can_answer and isinstance(error, pa.ArrowException):  # a handler in `install` would load pyarrow
                await unreadable(error)(scope, receive, send)
                return
            log.exception("unexpected error in %s %s", scope["type"], scope.get("path", ""))
            if not can_answer:
                raise
            body = ErrorBody(code="internal", message="the server failed on this request; its log says why")
            await reply(500, body)(scope, receive, send)
