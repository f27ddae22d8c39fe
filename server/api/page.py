"""Serves the built page and its files; an unknown address answers 404."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.requests import HTTPConnection
from starlette.responses import HTMLResponse, Response
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send
from starlette.websockets import WebSocket

from server.api.gate import plain_page, wants_page

BUILT, PACKAGED = Path(__file__).resolve().parents[2] / "web" / "dist", Path(__file__).resolve().parents[1] / "page"
DIST = PACKAGED if PACKAGED.is_dir() else BUILT
"""The page of the wheel, or of the checkout."""
OURS = ("/api/", "/health/", "/benches/", "/assets/", "/lti")
"""An unknown path below these is an error, not a page."""

NOT_BUILT = (
    "The service runs, but its page has not been built: stop it and start it with `make run`. "
    "The programming interface is at /api/v1/openapi.json."
)


class Page:
    """The single-page application.

    Parameters
    ----------
    folder : Path
        The folder of the build.
    prefix : str
        The prefix a proxy takes off every path.
    """

    def __init__(self, folder: Path = DIST, prefix: str = "") -> None:
        self._folder, self._prefix = folder, prefix
        self._files = StaticFiles(directory=folder, check_dir=False)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve the page at the root, or a file of the build, or answer 404."""
        if scope["type"] == "websocket":
            await WebSocket(scope, receive, send).close(4404, "no such stream")
            return
        response = await self._response(scope)
        await response(scope, receive, send)

    def shown(self, scope: Scope, status: int = 200) -> Response:
        """Return the page, also below its root: all addresses in it are relative to its base.

        Libraries of it write styles, which the policy knows by the nonce of this answer.
        """
        index = self._folder / "index.html"
        if not index.is_file():
            return HTMLResponse(plain_page(503, "The page is not built", NOT_BUILT), 503)
        nonce = f'<meta name="nonce" content="{scope.get("nonce", "")}"></head>'
        text = index.read_text("utf-8").replace("</head>", nonce, 1)
        text = text.replace('<base href="/"', f'<base href="{self._prefix}/"', 1)
        return HTMLResponse(text, status, {"Cache-Control": "no-cache"})

    async def _response(self, scope: Scope) -> Response:
        path = scope["path"]
        if scope["method"] not in ("GET", "HEAD"):
            raise HTTPException(405 if not path.startswith(OURS) else 404)
        if path == "/":
            return self.shown(scope)
        if (self._folder / "index.html").is_file():
            try:
                return await self._file(path, scope)
            except HTTPException as error:
                if error.status_code != 404:
                    raise
        if path.startswith(OURS) or not wants_page(HTTPConnection(scope)):
            raise HTTPException(404)
        return self.shown(scope, 404)

    async def _file(self, path: str, scope: Scope) -> Response:
        """Return a file of the build; a caller that accepts compression gets the compressed file of the build."""
        name, response = path.lstrip("/"), None
        if takes_gzip(Headers(scope=scope)):
            with suppress(HTTPException):  # there is no such file
                response = await self._files.get_response(f"{name}.gz", scope)
                response.headers["Content-Encoding"] = "gzip"
        if response is None:
            response = await self._files.get_response(name, scope)
        response.headers["Vary"] = "Accept-Encoding"
        # The build puts a hash into the name of every asset.
        is_hashed = path.startswith("/assets/")
        response.headers["Cache-Control"] = "public, max-age=31536000, immutable" if is_hashed else "no-cache"
        return response


def takes_gzip(headers: Headers) -> bool:
    """Return whether a caller names gzip among the encodings it takes, and not with the weight 0 (RFC 9110, 12.5.3)."""
    for offer in headers.get("accept-encoding", "").lower().split(","):
        name, _, weight = offer.replace(" ", "").partition(";q=")
        if name == "gzip":
            return weight.strip("0.") != "" if weight else True
    return False
