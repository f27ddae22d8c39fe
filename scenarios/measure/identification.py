"""The device that a swept sine identifies on a board, beside the nominal device: figures, tones and curves."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import BaseModel, Field

from core.board.board import Board
from core.device.device import Device
from core.device.frequency import response
from core.device.identification import Identified
from core.units import UM_PER_M
from scenarios.measure.sweep_sine import sweep_sine

CURVE_POINTS = 300


class MeasuredTone(BaseModel):
    """One tone: displacement per volt, its standard error and its phase, the sign of the force left out."""

    frequency_hz: float
    gain_um_per_v: float
    error_um_per_v: float
    phase_deg: float


class FittedCurve(BaseModel):
    """The response of the device found, and the response of the nominal device."""

    frequency_hz: list[float]
    found_um_per_v: list[float]
    found_deg: list[float]
    nominal_um_per_v: list[float]
    nominal_deg: list[float]


class Identification(BaseModel):
    """The device that a swept sine identifies on a bench as it is now."""

    tick: int
    found: Identified
    nominal: dict[str, float] = Field(
        description="Figures of the device as it is meant to be, in the air of the catalogue, without faults"
    )
    tones: list[MeasuredTone]
    curve: FittedCurve


def identification(board: Board, believed: Device | None = None, **settings: Any) -> Identification:
    """Identify the device of a board in its present state, on a copy.

    Parameters
    ----------
    board : Board
        The board, its faults and its environment included.
    believed : Device, optional
        The device as people know it, where faults are hidden.
    **settings
        Further arguments of `sweep_sine`.
    """
    sweep = sweep_sine(board, believed=believed, **settings)
    device = believed or board.spec.device
    force = device.signed_force_n_per_v
    sign = 1.0 if force > 0.0 else -1.0
    found, nominal = sweep.found, device.metrics()
    grid = np.geomspace(sweep.tones[0].frequency_hz, sweep.tones[-1].frequency_hz, CURVE_POINTS)
    unit = abs(force) * UM_PER_M
    response_found = response(found.mass_kg, found.damping_ns_m, found.stiffness_n_m, grid) * unit
    response_meant = response(nominal["mass_kg"], nominal["damping_ns_m"], nominal["stiffness_n_m"], grid) * unit
    return Identification(
        tick=board.tick,
        found=found,
        nominal=nominal,
        tones=[
            MeasuredTone(
                frequency_hz=tone.frequency_hz,
                gain_um_per_v=abs(tone.response),
                error_um_per_v=tone.error,
                phase_deg=float(np.degrees(np.angle(sign * tone.response))),
            )
            for tone in sweep.tones
        ],
        curve=FittedCurve(
            frequency_hz=grid.tolist(),
            found_um_per_v=np.abs(response_found).tolist(),
            found_deg=np.degrees(np.angle(response_found)).tolist(),
            nominal_um_per_v=np.abs(response_meant).tolist(),
            nominal_deg=np.degrees(np.angle(response_meant)).tolist(),
        ),
    )
