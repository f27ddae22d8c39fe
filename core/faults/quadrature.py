"""Quadrature."""

from __future__ import annotations

from typing import Any, cast

from core.block import Context, Equation, parameter
from core.device.two_axis import TwoAxis
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record
from core.units import rate_rad_ms


class Quadrature(Fault):
    r"""The axes of the suspension turn against the layout: a spring couples x and y.

    .. math:: k_{xy}\to k_{xy}+2m_c\omega_x\Omega_q,\quad\omega_x=\sqrt{k_{xx}/m_x}

    A read-out with a wrong phase takes part of it for a rate. Its size as a rate is the value of the nominal device,
    with y held at zero.
    """

    title = "Quadrature"
    group, place = "Suspension", 6
    shows = "beams"
    changes = "spring between x and y; its force along y is in step with the displacement along x"
    suggested = 500.0
    axes = ("x", "y")
    equations = (Equation("effect", r"k_{xy}\to k_{xy}+2m_c\omega_x\Omega_q", "6.1.3"),)

    class Params(FaultParams):
        """Severity is the added cross stiffness, read as a rate."""

        severity: float = parameter(0.0, "added cross stiffness, read as a rate", "deg/s", ge=-1e6, le=1e6)

    class Packed(PackedFault):
        """Profile and severity, and the cross stiffness of 1 deg/s, uN/um."""

        per_dps: float

    class Ports(BlockPorts):
        """The cross stiffness."""

        cross_stiffness: float = effect("cross_stiffness")
        severity: float = severity("deg/s", "added cross stiffness, read as a rate")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack severity and profile, and the cross stiffness of 1 deg/s."""
        p: Quadrature.Packed = super().pack(params, context)
        p.per_dps = cast(TwoAxis, context.device).cross_stiffness(rate_rad_ms(1.0))
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Add to the cross stiffness."""
        now = severity_now(p, x.tick)
        x.severity = now
        if now != 0.0:
            x.cross_stiffness += now * p.per_dps
