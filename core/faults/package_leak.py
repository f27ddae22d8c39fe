"""Leak of the package."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record


class PackageLeak(Fault):
    r"""Air leaks into an evacuated package; the damping of its gas grows with the pressure.

    .. math:: d\to d\left[1+g\,\frac{s}{p_0}\right]

    so that at the pressure :math:`p=p_0+s` it is :math:`d_0(1-g+gp/p_0)`. Molecules then hit the walls more often than
    each other, and their drag is proportional to their number: below 1 kPa the mean free path is more than 6 um. How
    much of the damping is gas, and the pressure the device was measured at, are assumed here; a drawn gyroscope states
    the pressure. Damping along both axes and between them grows alike. The environment's pressure is that outside the
    package, and does not count.
    """

    title = "Leak of the package"
    group, place = "Gas and friction", 11
    shows = "film"
    changes = "damping along both axes; the quality factors fall, amplitude and phase take more force"
    suggested = 125.0
    axes = ("x", "y")
    equations = (Equation("effect", r"d\to d\,(1-g+g\,p/p_0),\quad p=p_0+s", "1.3.7, free molecules"),)

    class Params(FaultParams):
        """Severity is the pressure gained."""

        severity: float = parameter(0.0, "pressure gained", "Pa", ge=0, le=1000)
        package_pa: float = parameter(100.0, "pressure in the package before; assumed", "Pa", ge=1e-3, le=1000)
        gas_share: float = parameter(0.8, "share of the damping that is gas before the leak; assumed", "1", ge=0, le=1)

    class Packed(PackedFault):
        """Profile and severity, and the damping gained per Pa, over nominal."""

        per_pa: float

    class Ports(BlockPorts):
        """The damping."""

        damping_scale: float = effect("damping_scale")
        severity: float = severity("Pa", "pressure gained")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack severity and profile, and the damping per pressure."""
        p: PackageLeak.Packed = super().pack(params, context)
        p.per_pa = params.gas_share / params.package_pa
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Raise the damping."""
        gained = severity_now(p, x.tick)
        x.severity = gained
        if gained != 0.0:
            x.damping_scale *= 1.0 + p.per_pa * gained
