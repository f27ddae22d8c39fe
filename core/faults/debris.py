"""Debris."""

from __future__ import annotations

from typing import Any, Literal

from core.block import Context, Equation, parameter
from core.device.geometry import drawn
from core.device.lateral import lateral
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record

COMBS = {"right": 1.0, "left": 2.0}


class Debris(Fault):
    r"""A particle between fingers: a spring off the axis, with drag if wanted, and a short when it conducts.

    .. math:: U\to U+\tfrac12sk\,(x-y_d\theta)^2
    """

    title = "Debris"
    group, place = "Drive and combs", 17
    shows = "fingers"
    changes = (
        "stiffness and damping in every plant, and a short of one comb when it conducts; the rotation in the planar "
        "plant only"
    )
    suggested = 0.1
    equations = (Equation("effect", r"U\to U+\tfrac12sk\,(x-y_d\theta)^2", "3.1.3.2, 5.1.2"),)

    class Params(FaultParams):
        """Severity is the spring of the particle as a share of the nominal stiffness."""

        severity: float = parameter(0.0, "stiffness of the particle, share of nominal", "1", ge=0, le=20)
        damping: float = parameter(0.0, "drag of the particle, share of the nominal damping", "1", ge=0, le=20)
        place_um: float = parameter(200.0, "where along the comb, from the axis", "um", ge=-344, le=344)
        conductive: bool = parameter(False, "whether it shorts the comb it is in")
        comb: Literal["right", "left"] = parameter("right", "which comb it is in, seen with +x to the right")

    class Packed(PackedFault):
        """Profile and severity, then the effects at full severity: added shares, a turn, the shorted combs."""

        stiffness: float
        damping: float
        rotation: float
        turn: float
        shorted: float

    class Ports(BlockPorts):
        """The suspension, the damping, and the combs."""

        stiffness_scale: float = effect("stiffness_scale")
        damping_scale: float = effect("damping_scale")
        rotation_scale: float = effect("rotation_scale")
        turn: float = effect("turn")
        short: float = effect("short")
        other: float = effect("other")
        severity: float = severity("1", "stiffness of the particle, share of nominal")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack severity, profile and effects: the spring as seen along x with the shuttle free to turn."""
        resists = 1e12 * lateral(drawn(context)).rotation_stiffness_nm
        spring = params.severity * context.device.stiffness
        turning = spring * params.place_um * params.place_um / resists
        p: Debris.Packed = super().pack(params, context)
        p.stiffness = params.severity / (1.0 + turning)
        p.rotation = turning
        p.turn = spring * params.place_um / resists / (1.0 + turning)
        p.shorted = COMBS[params.comb] if params.conductive else 0.0
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Add the spring of the particle, its drag, and a short when it conducts."""
        now = severity_now(p, x.tick)
        x.severity = now
        if now != 0.0:
            share = now / p.severity
            x.stiffness_scale *= 1.0 + share * p.stiffness
            x.damping_scale *= 1.0 + share * p.damping
            x.rotation_scale *= 1.0 + share * p.rotation
            x.turn += share * p.turn
            if p.shorted != 0.0:
                x.short = float(int(x.short) | int(p.shorted))
                x.other += now
