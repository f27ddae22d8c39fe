"""Answers to a designer: the figures, the frequency response and the spread of a device before it is built."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np
from pydantic import BaseModel, Field

from core.cards import EquationCard, equation_card
from core.device.quantities import QUANTITIES
from core.device.spread import Tolerances
from core.table import Words
from scenarios.design import SpreadStatistics, bode_band, designed, device_figures, process, sensitivities


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
    figures: list[Figure] = Field(description="Figures of this device; a transfer function has no mass, for example")
    metrics: dict[str, float] = Field(description="All figures by name")
    geometry: dict[str, float] | None = Field(description="All numbers of the drawing; null: it has no drawing")
    sensitivities: dict[str, dict[str, float]] = Field(
        description="For each number of the drawing: change of each parameter, in percent, for one step of it"
    )


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
    band: str = Field(description="Meaning of the band, in words")


class ProcessSpread(BaseModel):
    """Devices of one drawing from one process; the first of them as a drawing."""

    assumed: dict[str, float] = Field(description="Standard deviations of the process")
    statistics: dict[str, SpreadStatistics]
    geometry: dict[str, float] = Field(description="Numbers of the first drawn device that the process changes")


def evaluation(device: dict[str, Any], environment: dict[str, Any]) -> Evaluation:
    """Return the figures of a device in its environment."""
    spec = designed(device, environment)
    values, geometry, resonator = device_figures(spec), spec.device.geometry, spec.device.drawn_resonator
    return Evaluation(
        title=spec.device.title,
        source=spec.device.source,
        figures=[
            Figure(
                name=quantity.name,
                label=quantity.label,
                unit=quantity.unit,
                value=values[quantity.name],
                equation=equation_card(quantity.equation),
            )
            for quantity in QUANTITIES
            if quantity.name in values
        ],
        metrics=values,
        geometry=None if geometry is None else geometry.model_dump(),
        sensitivities={} if resonator is None else sensitivities(resonator),
    )


def bode(
    device: dict[str, Any], environment: dict[str, Any], start_hz: float, stop_hz: float, points: int, seed: int
) -> Bode:
    """Return the frequency response of a device with its tolerance band."""
    spec = designed(device, environment)
    band = bode_band(spec, np.geomspace(start_hz, stop_hz, points), seed)
    drawn = spec.device.geometry is not None
    return Bode(
        frequency_hz=band.frequency_hz.tolist(),
        magnitude_db=Curve(low=band.low_db.tolist(), nominal=band.nominal_db.tolist(), high=band.high_db.tolist()),
        phase_deg=Curve(low=band.low_deg.tolist(), nominal=band.nominal_deg.tolist(), high=band.high_deg.tolist()),
        static_gain_um_per_v=device_figures(spec)["static_gain_um_per_v"],
        band="1 to 99 % of devices from the process" if drawn else "mass, damping and stiffness 5 % more or less",
    )


def process_spread(device: dict[str, Any], environment: dict[str, Any], seed: int, draws: int) -> ProcessSpread:
    """Draw devices from the process."""
    spread = process(designed(device, environment), draws, seed)
    return ProcessSpread(
        assumed=asdict(Tolerances()),
        statistics={name: SpreadStatistics.of(spread, name) for name in spread.found},
        geometry={name: float(values[0]) for name, values in spread.drawn.items()},
    )
