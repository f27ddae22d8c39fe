"""The limit of request bodies: a larger one is refused and not held in memory."""

from __future__ import annotations

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
    """

    def __init__(self, app: ASGIApp, limit: int) -> None:
        self._app, self._limit = app, limit

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check the declared length first, then count the bytes that arrive."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        declared = Headers(scope=scope).get("content-length", "0")
        if not declared.isdecimal() or int(declared) > self._limit:
            error = self._too_large()
            await reply(413, error.body, error.headers)(scope, receive, send)
            return
        seen = 0

        async def counted() -> Message:
            nonlocal seen
            message = await receive()
            seen += len(message.get("body", b""))
            if seen > self._limit:
                raise self._too_large()
            return message

        await self._app(scope, counted, send)

    def _too_large(self) -> ApiError:
        """Build the refusal; the connection ends, because the rest of the body is not read."""
        message = f"the request body is larger than {self._limit} bytes"
        hint = "send less, or raise body_limit_bytes"
        return ApiError(413, "too_large", message, hint=hint, headers={"Connection": "close"})
