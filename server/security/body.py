"""The limit of request bodies: a larger one is refused and not held in memory."""

from __future__ import annotations

from collections.abc import Mapping

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from server.errors import ApiError, reply


class BodyLimit:
    """Answers 413 as soon as a body turns out too large.

    Parameters
    ----------
    app : ASGIApp
        The application to wrap.
    limit : int
        Bytes.
    uploads : mapping, optional
        Path of each upload, which its route puts into a file as it comes, with the limit and its setting.
    """

    def __init__(self, app: ASGIApp, limit: int, uploads: Mapping[str, tuple[int, str]] | None = None) -> None:
        self._app, self._usual, self._uploads = app, (limit, "body_limit_bytes"), uploads or {}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check the declared length first, then count the bytes that arrive."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        limit, setting = self._uploads.get(scope["path"], self._usual) if scope["method"] == "POST" else self._usual
        declared = Headers(scope=scope).get("content-length", "0")
        if not declared.isdecimal() or int(declared) > limit:
            error = too_large(limit, setting)
            await reply(413, error.body, error.headers)(scope, receive, send)
            return
        seen = 0

        async def counted() -> Message:
            nonlocal seen
            message = await receive()
            seen += len(message.get("body", b""))
            if seen > limit:
                raise too_large(limit, setting)
            return message

        await self._app(scope, counted, send)


def too_large(limit: int, setting: str) -> ApiError:
    """Build the refusal; the connection ends, because the rest of the body is not read."""
    message = f"the request body is larger than {limit} bytes"
    hint = f"send less, or raise {setting}"
    return ApiError(413, "too_large", message, hint=hint, headers={"Connection": "close"})
