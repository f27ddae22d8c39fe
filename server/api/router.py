"""Routers of the service.

Each route has its whole path from the beginning: a router that is included under a prefix is analysed a second time,
with the first request.
"""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter
from fastapi.routing import APIRoute

from server.api.bodies import StrictRoute

API = "/api/v1"


def name_of(route: APIRoute) -> str:
    """Return the name of an operation in the OpenAPI document."""
    return route.name


class Router(APIRouter):
    """Routes below ``/api/v1``; they read strict JSON.

    Parameters
    ----------
    prefix : str
        Beginning of their paths, below that.
    """

    def __init__(self, prefix: str = "", **settings: Any) -> None:
        super().__init__(prefix=API + prefix, route_class=StrictRoute, generate_unique_id_function=name_of, **settings)
