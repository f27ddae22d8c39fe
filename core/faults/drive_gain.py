"""Drive gain."""

from __future__ import annotations

from typing import Any, Literal

from core.block import Context, Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts, reads
from core.record import Record


class DriveGain(Fault):
    r"""The voltage at the comb differs from the applied voltage, :math:`v\to v(1+s)`, or is stuck.

    Controllers and diagnosers still read the voltage applied. At severity -1 the drive gives no voltage.
    """

    title = "Drive gain"
    group, place = "Drive and combs", 13
    shows = "drive"
    changes = "voltage that reaches the comb, in every plant; a bank knows a gain as a hypothesis, a stuck drive not"
    suggested = -0.2
    equations = (Equation("effect", r"v\to v\,(1+s)\quad\text{or}\quad v\to(1-|s|)\,v+|s|\,v(t_0)", "5.1.2"),)

    class Params(FaultParams):
        """Severity is a share of the gain, or the share that is stuck."""

        severity: float = parameter(0.0, "added gain, or share of the drive that is stuck", "1", ge=-1, le=20)
        mode: Literal["gain", "stuck"] = parameter("gain", "wrong gain, or stuck at the voltage of the injection")

    class Packed(PackedFault):
        """Profile and severity, and whether the drive is stuck."""

        stuck: float

    class State(Record):
        """The held voltage, and whether the drive holds it."""

        held: float
        holding: float

    class Ports(BlockPorts):
        """The voltage at the comb, and the applied one."""

        drive_gain: float = effect("drive_gain")
        drive_offset: float = effect("drive_offset")
        other: float = effect("other")
        voltage: float = reads("drive.voltage", "V", "voltage")
        severity: float = severity("1", "added gain, or share of the drive that is stuck")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack severity, profile and mode."""
        p: DriveGain.Packed = super().pack(params, context)
        p.stuck = float(params.mode == "stuck")
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Multiply the voltage that reaches the comb, or hold it."""
        now = severity_now(p, x.tick)
        x.severity = now
        if now == 0.0:
            s.holding = 0.0
        elif p.stuck == 0.0:
            x.drive_gain *= 1.0 + now
        else:
            if s.holding == 0.0:
                s.holding = 1.0
                s.held = x.voltage
            share = min(abs(now), 1.0)
            x.drive_gain *= 1.0 - share
            x.drive_offset += share * s.held
            x.other += share
