"""Serves the built page; addresses that are no route of the service lead to it."""

from __future__ import annotations

from pathlib import Path

from starlette.exceptions import HTTPException
from starlette.responses import FileResponse, HTMLResponse, RedirectResponse, Response
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send
from starlette.websockets import WebSocket

from server.security.gate import page

DIST = Path(__file__).resolve().parent.parent / "web" / "dist"
OURS = ("/api/", "/health/", "/benches/", "/assets/")
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
                response = await self._files.get_response(path.lstrip("/"), scope)
            except HTTPException as error:
                if error.status_code != 404:
                    raise
            else:
                # The build puts a hash into the name of every asset.
                hashed = path.startswith("/assets/")
                response.headers["Cache-Control"] = "public, max-age=31536000, immutable" if hashed else "no-cache"
                return response
        if path.startswith(OURS):
            raise HTTPException(404)
        if not index.is_file():
            return HTMLResponse(page(503, "The page is not built", NOT_BUILT), 503)
        if path != "/":
            query = scope["query_string"].decode("latin-1")
            return RedirectResponse(f"/?{query}" if query else "/", 303)
        return FileResponse(index, headers={"Cache-Control": "no-cache"})
