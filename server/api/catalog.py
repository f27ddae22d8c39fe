"""The catalogue of blocks."""

from __future__ import annotations

import gzip
from functools import cache

from fastapi import Request, Response
from pydantic import BaseModel

from core.cards import BlockCard
from core.registry import catalog
from server.api.page import takes_gzip
from server.api.router import Router
from server.version import VERSION

router = Router(tags=["catalogue"])


class Catalogue(BaseModel):
    """Every block with its equations, parameters and ports."""

    version: str
    blocks: list[BlockCard]


@router.get("/catalog", response_model=Catalogue)
def get_catalog(request: Request, family: str | None = None) -> Response:
    """List every block, or the blocks of one family."""
    headers = {"Vary": "Accept-Encoding"}
    if not takes_gzip(request.headers):
        return Response(_written(family), media_type="application/json", headers=headers)
    headers["Content-Encoding"] = "gzip"
    return Response(_compressed(family), media_type="application/json", headers=headers)


@cache
def _written(family: str | None) -> bytes:
    """Return the catalogue as text; making it takes 0.1 s, and every page that opens requests it."""
    return Catalogue(version=VERSION, blocks=catalog(family)).model_dump_json().encode()


@cache
def _compressed(family: str | None) -> bytes:
    return gzip.compress(_written(family))
