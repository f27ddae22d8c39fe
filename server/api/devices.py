"""Devices: the devices of the catalogue, and any design."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np
from pydantic import BaseModel, Field

from core import registry
from core.cards import EquationCard, ParameterCard, equation_card, parameter_cards
from core.device.catalogue import devices
from core.device.device import Device
from core.device.geometry import Geometry
from core.device.quantities import QUANTITIES
from core.device.spread import Tolerances
from core.table import Words
from scenarios.design import Statistics, bode_band, designed, device_figures, process, sensitivities
from server.api.bodies import Body
from server.api.deps import ComputingDep
from server.api.router import Router

router = Router(prefix="/devices", tags=["devices"])


class DeviceCard(BaseModel):
    """A device of the catalogue."""

    id: str
    title: Words
    source: Words
    metrics: dict[str, float]
    parameters: dict[str, Any]
    plants: list[str] = Field(description="Plants that suit it")


class Devices(BaseModel):
    """Every device of the catalogue, and the choices of a drawing."""

    devices: list[DeviceCard]
    geometry: list[ParameterCard]


class Design(Body):
    """A device and the air around it, as in a scenario."""

    device: dict[str, Any] = Field({}, description="Catalogue id, and values written over it")
    environment: dict[str, Any] = Field({}, description="Temperature, pressure, humidity")


class Figure(BaseModel):
    """A figure of a device with its equation."""

    name: str
    label: str
    unit: str
    value: float
    equation: EquationCard


class Evaluation(BaseModel):
    """The figures of a device, worked out before it is built."""

    title: Words
    source: str
    figures: list[Figure] = Field(description="Those it has: a transfer function has no mass, no comb pulls it in")
    metrics: dict[str, float] = Field(description="All figures by name")
    geometry: dict[str, float] | None = Field(description="The drawing, complete; null without one")
    sensitivities: dict[str, dict[str, float]] = Field(
        description="Change of each parameter in percent for one step of a number of the drawing"
    )


class BodeOf(Design):
    """A request for a Bode diagram."""

    start_hz: float = Field(200.0, gt=0, le=1e8)
    stop_hz: float = Field(20_000.0, gt=0, le=1e8)
    points: int = Field(300, ge=2, le=2000)
    seed: int = Field(1, ge=0, le=2**53, description="Of the devices drawn for the band")


class Curve(BaseModel):
    """A quantity over frequency, and its band."""

    low: list[float]
    nominal: list[float]
    high: list[float]


class Bode(BaseModel):
    """Displacement per volt over the static gain of the nominal device; the sign of the force is left out."""

    frequency_hz: list[float]
    magnitude_db: Curve
    phase_deg: Curve
    static_gain_um_per_v: float
    band: str = Field(description="Meaning of the band")


class SpreadOf(Design):
    """A request for devices drawn from the process."""

    seed: int = Field(1, ge=0, le=2**53)
    draws: int = Field(2000, ge=2, le=20_000)


class SpreadStatistics(BaseModel):
    """The spread of one parameter."""

    variation_pct: float
    p01: float
    p50: float
    p99: float


class ProcessSpread(BaseModel):
    """Devices of one drawing from one process; the first of them as a drawing."""

    assumed: dict[str, float] = Field(description="Standard deviations of the process")
    statistics: dict[str, SpreadStatistics]
    geometry: dict[str, float] = Field(description="The numbers of the first device drawn that the process moved")


@router.get("")
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
                plants=plants_for(device),
            )
            for device in devices()
        ],
        geometry=parameter_cards(Geometry),
    )


def plants_for(device: Device) -> list[str]:
    """Return the plants that do not refuse a device."""
    oscillator = device.oscillator()
    return [name for name, plant in registry.blocks("plant").items() if not plant.unsuited(oscillator, oscillator)]


@router.post("/evaluate")
async def evaluate(body: Design, computing: ComputingDep) -> Evaluation:
    """Work out the figures of a device in its environment."""
    return await computing.call(_evaluate, body)


def _evaluate(body: Design) -> Evaluation:
    spec = designed(body.device, body.environment)
    figures, geometry, resonator = device_figures(spec), spec.device.geometry, spec.device.drawn_resonator
    return Evaluation(
        title=spec.device.title,
        source=spec.device.source,
        figures=[
            Figure(
                name=quantity.name,
                label=quantity.label,
                unit=quantity.unit,
                value=figures[quantity.name],
                equation=equation_card(quantity.equation),
            )
            for quantity in QUANTITIES
            if quantity.name in figures
        ],
        metrics=figures,
        geometry=None if geometry is None else geometry.model_dump(),
        sensitivities={} if resonator is None else sensitivities(resonator),
    )


@router.post("/bode")
async def bode(body: BodeOf, computing: ComputingDep) -> Bode:
    """Return the frequency response of a device with its tolerance band."""
    return await computing.call(_bode, body)


def _bode(body: BodeOf) -> Bode:
    spec = designed(body.device, body.environment)
    band = bode_band(spec, np.geomspace(body.start_hz, body.stop_hz, body.points), body.seed)
    drawn = spec.device.geometry is not None
    return Bode(
        frequency_hz=band.frequency_hz.tolist(),
        magnitude_db=Curve(low=band.low_db.tolist(), nominal=band.nominal_db.tolist(), high=band.high_db.tolist()),
        phase_deg=Curve(low=band.low_deg.tolist(), nominal=band.nominal_deg.tolist(), high=band.high_deg.tolist()),
        static_gain_um_per_v=device_figures(spec)["static_gain_um_per_v"],
        band="1 to 99 % of devices from the process" if drawn else "mass, damping and stiffness 5 % more or less",
    )


@router.post("/spread")
async def spread(body: SpreadOf, computing: ComputingDep) -> ProcessSpread:
    """Draw devices from the process; the same seed gives the same devices."""
    return await computing.call(_spread, body)


def _spread(body: SpreadOf) -> ProcessSpread:
    spread = process(designed(body.device, body.environment), body.draws, body.seed)
    return ProcessSpread(
        assumed=asdict(Tolerances()),
        statistics={name: SpreadStatistics(**asdict(Statistics.of(spread, name))) for name in spread.found},
        geometry={name: float(values[0]) for name, values in spread.drawn.items()},
    )
