"""The resonance of a device, as a sweep shows it: the measurement that shows a fault that was hidden."""

from __future__ import annotations

from collections.abc import Mapping

from pydantic import BaseModel, Field

from core.board.spec import Spec
from core.device.frequency import figures
from core.units import UM_PER_M


class Resonance(BaseModel):
    """The figures that a sweep shows, in the air of the bench."""

    f0_hz: float
    quality_factor: float
    rest_um_per_v: float = Field(description="Displacement per volt far below the resonance")
    peak_um_per_v: float = Field(description="Displacement per volt at the peak")


def resonance_of(spec: Spec, factors: Mapping[str, float]) -> Resonance | None:
    """Return the resonance of the device of a bench with factors on it; none for a device of two axes.

    Parameters
    ----------
    spec : Spec
        The bench.
    factors : mapping
        Mass, stiffness, damping and gain over the values of the device, where a fault changes them.
    """
    device = spec.device
    if device.usual_plant != "linear":
        return None
    in_air = dict(zip(("stiffness", "damping"), spec.surroundings, strict=True))
    mass, damping, stiffness = (
        device.resolved[field] * factors.get(part, 1.0) * in_air.get(part, 1.0)
        for part, field in (("mass", "mass_kg"), ("damping", "damping_ns_m"), ("stiffness", "stiffness_n_m"))
    )
    shown = figures(mass, damping, stiffness)
    rest = abs(device.signed_force_n_per_v) * factors.get("gain", 1.0) / stiffness * UM_PER_M
    return Resonance(
        f0_hz=shown["f0_hz"],
        quality_factor=shown["quality_factor"],
        rest_um_per_v=rest,
        peak_um_per_v=rest * 10.0 ** (shown["peak_db"] / 20.0),
    )
