"""Short circuit."""

from __future__ import annotations

from typing import Any, Literal

from core.block import Context, Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record

COMBS = {"right": 1.0, "left": 2.0, "both": 3.0}


class ShortCircuit(Fault):
    r"""Stator and shuttle on one potential: no voltage across that comb, the other one pulls alone.

    This is a failure, not a fault (5.1.2): the short stays after the fault is healed, until the board is reset.
    """

    title = "Short circuit"
    group, place = "Drive and combs", 15
    shows = "fingers"
    changes = "force of one comb or of both, in every plant, until the board is reset; the board stops"
    suggested = 1.0
    equations = (Equation("effect", r"V_{b1}-v\to0\ \text{(at +x)},\quad V_{b2}-v\to0\ \text{(at -x)}", "5.1.2"),)

    class Params(FaultParams):
        """Any severity but 0 is a whole short."""

        severity: float = parameter(0.0, "1 for a short", "1", ge=0, le=1)
        comb: Literal["right", "left", "both"] = parameter("right", "which comb, seen with +x to the right")

    class Packed(PackedFault):
        """Profile and severity, and the combs: 1 at +x, 2 at -x, 3 both."""

        combs: float

    class Ports(BlockPorts):
        """The combs."""

        short: float = effect("short")
        other: float = effect("other")
        severity: float = severity("1", "1 while the short is forced")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack severity, profile and comb."""
        p: ShortCircuit.Packed = super().pack(params, context)
        p.combs = COMBS[params.comb]
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Short the comb."""
        now = severity_now(p, x.tick)
        x.severity = now
        if now != 0.0:
            x.short = float(int(x.short) | int(p.combs))
            x.other += now
