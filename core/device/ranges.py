"""How small and how large the numbers of a device may be.

Many orders of magnitude to either side of anything built, so that nothing worked out from them leaves the floating
point numbers: squares of stiffness, of gains and of their ratios are formed on the way.
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
"""Of a part that may be missing."""
EtchUm = Annotated[float, Field(ge=-1e5, le=1e5)]
"""What is taken from an edge, or grows on it."""
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
BiasV = Annotated[Sized, Field(ge=-1e3, le=1e3)]


class Resonator(Table):
    """Mass, damping and stiffness of a resonator, however they are given."""

    mass_kg: MassKg
    damping_ns_m: DampingNsM
    stiffness_n_m: StiffnessNM
