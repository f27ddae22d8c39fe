"""Shorted pairs of fingers of one comb."""

from __future__ import annotations

from typing import Any, Literal, Self

from pydantic import model_validator

from core.block import Context, Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record


class FingerPairShort(Fault):
    r"""Particles short some fingers of one comb, and their gaps push no more, :math:`F\to F(1-s/n)`.

    The resistance of a shorted finger is assumed to hold off the voltage of the rest of the comb. The finger then has
    the voltage of the mass, and no field is left in the gaps on its two sides: that is the force of one pair. Their
    pulls across the comb cancelled before, so none is left. Left out are the softening that these gaps gave across the
    comb, 1e-4 of the stiffness of ``gyro-c`` for 15 V, gaps of 2 um and fingers that overlap by 10 um and are
    20 um thick, and the spring of the particles. The number of pairs is assumed too: the devices are driven by forces
    and state no comb.
    """

    title = "Shorted finger pairs"
    group, place = "Drive and combs", 16
    shows = "fingers"
    changes = "force along one axis; a bank knows a weaker force along x as a hypothesis, along y not"
    suggested = 1.0
    axes = ("x", "y")
    equations = (Equation("effect", r"F\to F\,(1-s/n)"),)

    class Params(FaultParams):
        """Severity is the number of pairs; the comb they are in."""

        severity: float = parameter(0.0, "pairs of fingers that are shorted", "pair", ge=0, le=10_000)
        axis: Literal["x", "y"] = parameter("y", "comb they are in: x drives, y senses and rebalances")
        pairs: int = parameter(100, "pairs of fingers of the comb; assumed", ge=1, le=10_000)

        @model_validator(mode="after")
        def _within_the_comb(self) -> Self:
            if self.severity > self.pairs:
                raise ValueError(f"the comb has {self.pairs} pairs, so no more than these can be shorted")
            return self

    class Packed(PackedFault):
        """Profile and severity, whether the comb belongs to y, share of the force per pair."""

        along_y: float
        per_pair: float

    class Ports(BlockPorts):
        """The forces along both axes."""

        drive_gain: float = effect("drive_gain")
        second_drive_gain: float = effect("second_drive_gain")
        other: float = effect("other")
        severity: float = severity("pair", "pairs of fingers that are shorted")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack severity and profile, the axis, and the share of a pair."""
        p: FingerPairShort.Packed = super().pack(params, context)
        p.along_y = params.axis == "y"
        p.per_pair = 1.0 / params.pairs
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Take the force of the shorted pairs away."""
        shorted = severity_now(p, x.tick)
        x.severity = shorted
        if shorted != 0.0:
            left = 1.0 - shorted * p.per_pair
            if p.along_y != 0.0:
                x.second_drive_gain *= left
                x.other += 1.0
            else:
                x.drive_gain *= left
