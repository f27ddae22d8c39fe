"""Ranges of the numbers of a device.

They reach many orders of magnitude to either side of any real device, and still keep all results within the floating
point numbers, which include squares of stiffness, of gains and of their ratios.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field

from core.table import Table

MassKg = Annotated[float, Field(ge=1e-18, le=1e3)]
DampingNsM = Annotated[float, Field(ge=1e-40, le=1e3)]
StiffnessNM = Annotated[float, Field(ge=1e-9, le=1e9)]
ForceNPerV = Annotated[float, Field(ge=1e-15, le=1e3)]
LengthUm = Annotated[float, Field(ge=1e-3, le=1e5)]
PartUm = Annotated[float, Field(ge=0.0, le=1e5)]
"""A part that may be missing."""
EtchUm = Annotated[float, Field(ge=-1e5, le=1e5)]
"""A loss from an edge, or a growth on it."""
Fingers = Annotated[int, Field(ge=1, le=100_000)]

LEAST, MOST = 1e-9, 1e9


def _sized(value: float) -> float:
    if 0.0 < abs(value) < LEAST:
        raise ValueError(f"must be 0, or at least {LEAST:g} in size, got {value:g}")
    if abs(value) > MOST:
        raise ValueError(f"must be at most {MOST:g} in size, got {value:g}")
    return value


Sized = Annotated[float, AfterValidator(_sized)]
"""A number of either sign that is 0 or neither very small nor very large."""
BiasV = Annotated[float, Field(ge=-1e3, le=1e3), AfterValidator(_sized)]


class Resonator(Table):
    """Mass, damping and stiffness of a resonator, measured or computed from a drawing."""

    mass_kg: MassKg
    damping_ns_m: DampingNsM
    stiffness_n_m: StiffnessNM
