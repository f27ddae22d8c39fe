"""Devices: the devices of the catalogue, and any design."""

from __future__ import annotations

from functools import partial

from pydantic import BaseModel, Field

from core import registry
from core.cards import ParameterCard, parameter_cards
from core.device.catalogue import devices
from core.device.device import Device
from core.device.electrodes import Comb, TuningElectrode
from core.device.geometry import Geometry
from core.table import Words
from scenarios import designer
from scenarios.designer import Bode, Evaluation, ProcessSpread
from server.api.bodies import AnswerBody, Body, DeviceDocument, EnvironmentDocument
from server.api.deps import ServiceDep
from server.api.router import Router

router = Router(prefix="/devices", tags=["devices"])


class DeviceCard(AnswerBody):
    """A device of the catalogue."""

    id: str
    title: Words
    source: Words
    metrics: dict[str, float]
    parameters: DeviceDocument
    plants: list[str] = Field(description="Plants that can be used with this device")


class DeviceList(BaseModel):
    """Every device of the catalogue, and the choices of a drawing and of electrodes."""

    devices: list[DeviceCard]
    geometry: list[ParameterCard]
    fringing: ParameterCard = Field(description="The field beyond the facing sides of fingers, of a resonator")
    comb: list[ParameterCard] = Field(description="electrodes.drive and electrodes.sense of a gyroscope")
    tuning: list[ParameterCard] = Field(description="electrodes.tuning of a gyroscope")


class Design(Body):
    """A device and the air around it, as in a scenario."""

    device: DeviceDocument = Field({}, description="Id of the catalogue, and values that replace its values")
    environment: EnvironmentDocument = Field(
        {}, description="Temperature, pressure, humidity; left out: the usual values"
    )


class BodeOf(Design):
    """A request for a Bode diagram."""

    start_hz: float = Field(200.0, gt=0, le=1e8)
    stop_hz: float = Field(20_000.0, gt=0, le=1e8)
    points: int = Field(300, ge=2, le=2000)
    seed: int = Field(1, ge=0, le=2**53, description="Seed of the devices that are drawn for the band")


class SpreadOf(Design):
    """A request for devices drawn from the process."""

    seed: int = Field(1, ge=0, le=2**53)
    draws: int = Field(2000, ge=2, le=20_000)


@router.get("")
def get_devices() -> DeviceList:
    """List every device."""
    return DeviceList(
        devices=[
            DeviceCard.of(
                device,
                metrics=device.metrics(),
                parameters=device.model_dump(exclude_none=True, exclude={"id", "title", "source"}),
                plants=plants_for(device),
            )
            for device in devices()
        ],
        geometry=parameter_cards(Geometry),
        fringing=next(card for card in parameter_cards(Device) if card.name == "fringing"),
        comb=parameter_cards(Comb),
        tuning=parameter_cards(TuningElectrode),
    )


def plants_for(device: Device) -> list[str]:
    """Return the plants that do not refuse a device."""
    oscillator = device.oscillator()
    return [name for name, plant in registry.blocks("plant").items() if not plant.unsuited(oscillator, oscillator)]


@router.post("/evaluate")
async def evaluate(body: Design, service: ServiceDep) -> Evaluation:
    """Work out the figures of a device in its environment."""
    return await service.computing.call(partial(designer.evaluation, **dict(body)))


@router.post("/bode")
async def bode(body: BodeOf, service: ServiceDep) -> Bode:
    """Return the frequency response of a device with its tolerance band."""
    return await service.computing.call(partial(designer.bode, **dict(body)))


@router.post("/spread")
async def spread(body: SpreadOf, service: ServiceDep) -> ProcessSpread:
    """Draw devices from the process; the same seed gives the same devices."""
    return await service.computing.call(partial(designer.process_spread, **dict(body)))
