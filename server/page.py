"""Serves the built page; addresses that are no route of the service lead to it."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send
from starlette.websockets import WebSocket

from server.compression import takes_gzip
from server.security.gate import page

DIST = Path(__file__).resolve().parent.parent / "web" / "dist"
OURS = ("/api/", "/health/", "/benches/", "/assets/", "/lti")
"""An unknown path below these is an error, not a page."""

NOT_BUILT = (
    "The service runs, but its page has not been built: stop it and start it with `make run`. "
    "The programming interface is at /api/v1/openapi.json."
)


class Page:
    """The single-page application. All addresses in it are relative, so it can be opened at one path only.

    Parameters
    ----------
    folder : Path
        The folder of the build.
    """

    def __init__(self, folder: Path = DIST) -> None:
        self._folder = folder
        self._files = StaticFiles(directory=folder, check_dir=False)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve the page, or a file of the build, or lead to the page."""
        if scope["type"] == "websocket":
            await WebSocket(scope, receive, send).close(4404, "no such stream")
            return
        response = await self._response(scope)
        await response(scope, receive, send)

    async def _response(self, scope: Scope) -> Response:
        if scope["method"] not in ("GET", "HEAD"):
            raise HTTPException(405 if not scope["path"].startswith(OURS) else 404)
        index = self._folder / "index.html"
        path = scope["path"]
        if path != "/" and (self._folder / "index.html").is_file():
            try:
                return await self._file(path, scope)
            except HTTPException as error:
                if error.status_code != 404:
                    raise
        if path.startswith(OURS):
            raise HTTPException(404)
        if not index.is_file():
            return HTMLResponse(page(503, "The page is not built", NOT_BUILT), 503)
        if path != "/":
            query = scope["query_string"].decode("latin-1")
            return RedirectResponse(f"/?{query}" if query else "/", 303)
        return index_page(index, scope)

    async def _file(self, path: str, scope: Scope) -> Response:
        """Return a file of the build; a caller who takes that gets what the build has compressed."""
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


def index_page(index: Path, scope: Scope) -> Response:
    """Return the page; libraries of it write styles, which the policy knows by the nonce of this answer."""
    nonce = f'<meta name="nonce" content="{scope.get("nonce", "")}"></head>'
    marked = index.read_text("utf-8").replace("</head>", nonce, 1)
    return HTMLResponse(marked, headers={"Cache-Control": "no-cache"})
