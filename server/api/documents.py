"""The site of the documents, which ``make docs`` builds, under ``/docs``."""

from __future__ import annotations

from pathlib import Path

from fastapi import APIRouter, Request, Response
from starlette.exceptions import HTTPException
from starlette.requests import HTTPConnection
from starlette.responses import HTMLResponse, RedirectResponse
from starlette.staticfiles import StaticFiles

from server.api.gate import plain_page, wants_page

BUILT, PACKAGED = Path(__file__).resolve().parents[2] / "docs" / "site", Path(__file__).resolve().parents[1] / "site"
SITE = PACKAGED if PACKAGED.is_dir() else BUILT
"""The site of the wheel, or of the checkout."""
NOT_BUILT = (
    "The documents are not built here. `make docs` builds them; their text is in the folder docs of the checkout."
)

router = APIRouter(include_in_schema=False)


def is_built() -> bool:
    """Whether there is a site to show."""
    return (SITE / "index.html").is_file()


@router.get("/docs")
async def lead_to_documents() -> Response:
    """Lead to the first page; addresses in the site are relative to its folder."""
    return RedirectResponse("/docs/", 308)


@router.get("/docs/{path:path}")
async def show_document(request: Request, path: str) -> Response:
    """Show a page or a file of the site; the page of a folder is its index."""
    try:
        name = f"{path}index.html" if path == "" or path.endswith("/") else path
        response = await StaticFiles(directory=SITE, check_dir=False).get_response(name, request.scope)
    except HTTPException as error:
        if error.status_code != 404 or not wants_page(HTTPConnection(request.scope)):
            raise
        text = "The site has no such page; its search is at /docs/search.html." if is_built() else NOT_BUILT
        return HTMLResponse(plain_page(404, "No such document", text), 404)
    response.headers["Cache-Control"] = "no-cache"
    return response
