"""Drive gain."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from core.block import Context, Equation, FloatArray, Port, parameter
from core.faults.fault import Fault, FaultParams, channels, severity_at

STUCK = 5
HELD, HOLDING = range(2)


def drive_gain_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Multiply the voltage that reaches the comb, or hold it."""
    severity = severity_at(p, w[0])
    w[io[4]] = severity
    if severity == 0.0:
        s[HOLDING] = 0.0
        return
    if p[STUCK] == 0.0:
        w[io[0]] *= 1.0 + severity
        return
    if s[HOLDING] == 0.0:
        s[HOLDING] = 1.0
        s[HELD] = w[io[3]]
    share = min(abs(severity), 1.0)
    w[io[0]] *= 1.0 - share
    w[io[1]] += share * s[HELD]
    w[io[2]] += share


class DriveGain(Fault):
    r"""The voltage at the comb is not the one applied, :math:`v\to v(1+s)`, or stays where it was when it stuck.

    Controllers and diagnosers are told the voltage applied. Severity -1 is a drive that gives nothing.
    """

    title = "Drive gain"
    shows = "drive"
    changes = "voltage that reaches the comb, in every plant; a bank knows a gain as a hypothesis, a stuck drive not"
    suggested = -0.2
    inputs = (*channels("drive_gain", "drive_offset", "other"), Port("voltage", "V", "voltage", source="drive.voltage"))
    outputs = (Port("severity", "1", "added gain, or share of the drive that is stuck"),)
    equations = (Equation("effect", r"v\to v\,(1+s)\quad\text{or}\quad v\to(1-|s|)\,v+|s|\,v(t_0)", "5.1.2"),)

    class Params(FaultParams):
        """Severity is a share of the gain, or the share that is stuck."""

        severity: float = parameter(0.0, "added gain, or share of the drive that is stuck", "1", ge=-1, le=20)
        mode: Literal["gain", "stuck"] = parameter("gain", "wrong gain, or stuck at the voltage of the injection")

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack severity, profile and mode."""
        return np.array([*super().pack(params, context).tolist(), float(params.mode == "stuck")])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Voltage held, and whether it is."""
        return np.zeros(2)

    step = drive_gain_step
