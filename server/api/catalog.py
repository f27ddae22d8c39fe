"""What there is: blocks and devices."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter
from pydantic import BaseModel

from core.device.catalogue import devices
from core.registry import BlockCard, catalog
from server.api.bodies import StrictRoute
from server.version import VERSION

router = APIRouter(tags=["catalogue"], route_class=StrictRoute)


class Catalogue(BaseModel):
    """Every block with its equations, parameters and ports."""

    version: str
    blocks: list[BlockCard]


class DeviceCard(BaseModel):
    """A device of the catalogue."""

    id: str
    title: str
    source: str
    metrics: dict[str, float]
    parameters: dict[str, Any]


class Devices(BaseModel):
    """Every device of the catalogue."""

    devices: list[DeviceCard]


@router.get("/catalog")
def get_catalog(family: str | None = None) -> Catalogue:
    """List every block, or those of one family."""
    return Catalogue(version=VERSION, blocks=catalog(family))


@router.get("/devices")
def get_devices() -> Devices:
    """List every device."""
    return Devices(
        devices=[
            DeviceCard(
                id=device.id,
                title=device.title,
                source=device.source,
                metrics=device.metrics(),
                parameters=device.model_dump(exclude_none=True, exclude={"id", "title", "source"}),
            )
            for device in devices()
        ]
    )
