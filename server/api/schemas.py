"""JSON Schemas of the documents that people write; editors fetch them without a token."""

from __future__ import annotations

import json
from functools import lru_cache
from typing import Annotated

from fastapi import Path, Request, Response
from pydantic import BaseModel, Field

from scenarios.json_schema.documents import TITLES, json_schema
from scenarios.reading import schema_file
from server.api.deps import ServiceDep
from server.api.router import API, Router
from server.errors import not_found
from server.service import Service

router = Router(prefix="/schemas", tags=["schemas"])

MEDIA_TYPE = "application/schema+json"


class SchemaCard(BaseModel):
    """A JSON Schema in a list."""

    name: str
    title: str
    url: str = Field(description="Its address, which is its $id too")


class SchemaList(BaseModel):
    """The JSON Schemas."""

    schemas: list[SchemaCard]


@router.get("")
def list_schemas(service: ServiceDep, request: Request) -> SchemaList:
    """List the JSON Schemas of the documents that people write."""
    return SchemaList(
        schemas=[
            SchemaCard(name=name, title=title, url=_address(service, request, name)) for name, title in TITLES.items()
        ]
    )


@router.get(
    "/{name}",
    response_class=Response,
    responses={200: {"content": {MEDIA_TYPE: {"schema": {"type": "object"}}}}},
)
def get_schema(
    name: Annotated[str, Path(description="scenario, campaign, sheet or lecture")],
    service: ServiceDep,
    request: Request,
) -> Response:
    """Return the JSON Schema of a kind of document; saved documents name its file."""
    if name not in TITLES:
        raise not_found("schema", name, f"list them at {API}/schemas", known=TITLES)
    headers = {"Content-Disposition": f'inline; filename="{schema_file(name)}"'}
    return Response(_written(name, _address(service, request, name)), media_type=MEDIA_TYPE, headers=headers)


def _address(service: Service, request: Request, name: str) -> str:
    """Return the address of a schema: behind a proxy the public one, else the one by which the caller came."""
    base = str(service.public) if service.public.origin else str(request.base_url).rstrip("/")
    return f"{base}{API}/schemas/{name}"


@lru_cache(maxsize=16)
def _written(name: str, address: str) -> bytes:
    return json.dumps(json_schema(name, address)).encode()
