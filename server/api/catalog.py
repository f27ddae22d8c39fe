"""The catalogue of blocks."""

from __future__ import annotations

from fastapi import APIRouter
from pydantic import BaseModel

from core.registry import BlockCard, catalog
from server.api.bodies import StrictRoute
from server.version import VERSION

router = APIRouter(tags=["catalogue"], route_class=StrictRoute)


class Catalogue(BaseModel):
    """Every block with its equations, parameters and ports."""

    version: str
    blocks: list[BlockCard]


@router.get("/catalog")
def get_catalog(family: str | None = None) -> Catalogue:
    """List every block, or those of one family."""
    return Catalogue(version=VERSION, blocks=catalog(family))
