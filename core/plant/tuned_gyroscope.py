r"""Vibrating gyroscope with a tuning electrode: plates that take stiffness along y away."""

from __future__ import annotations

import math
from typing import Any, ClassVar

from core.block import Context, Equation, Oscillator
from core.device.two_axis import TwoAxis
from core.kernel import kernel
from core.plant.gyroscope import EQUATIONS
from core.plant.two_axis_body import TwoAxisMotion
from core.plant.two_axis_plant import TwoAxisPlant, TwoAxisPorts, go, start, take_now
from core.ports import output, reads, tap
from core.record import Record
from core.units import MS_PER_S


class TunedGyroscope(TwoAxisPlant):
    r"""A gyroscope whose spring along y is softened by plates at a voltage V on both sides, which matches its modes.

    .. math:: k_{yy}\to k_{yy}-\frac{2\varepsilon_0AV^2}{g^3}

    The softening is linear; at a tenth of the gap the true one is 2 % more. Where the plates win over the spring, at
    :math:`V\ge V_{pi}` or beyond :math:`|y|=g\sqrt{1-V/V_{pi}}`, the mass is pulled in, and the board stops. A
    pilot force of the tuning controller acts along y besides the force of the drive.
    """

    title = "Gyroscope with a tuning electrode"
    axes = ("x", "y")
    slots: ClassVar[dict[str, str]] = {"drive": "drive_loop", "tuning": "tuning_voltage", "sense": "open_loop_rate"}
    equations = (
        *EQUATIONS,
        Equation("softening", r"k_{yy}\to k_{yy}-\frac{2\varepsilon_0AV^2}{g^3}", "not in the text"),
        Equation(
            "pull-in",
            r"V_{pi}=\sqrt{\frac{(k_{yy}-k_{xy}^2/k_{xx})\,g^3}{2\varepsilon_0A}},\quad|y|<g\sqrt{1-V/V_{pi}}",
            "not in the text",
        ),
    )

    class Packed(TwoAxisPlant.Packed):
        """In addition the plates: softening per squared volt, gap."""

        per_v2: float
        gap: float

    class State(Record):
        """The device as it is now, with its motion."""

        motion: TwoAxisMotion

    class Ports(TwoAxisPorts):
        """In addition the voltage on the plates, the pilot, and the split that comes of it."""

        tuning: float = reads("@tuning.tuning", "V", "voltage on the tuning electrode")
        pilot: float = reads("@tuning.pilot", "uN", "force along y besides the drive's")
        split: float = output("Hz", "frequency of y alone less that of x alone; minus where y is the lower")
        pulled_in: float = tap("1", "1 where the plates win over the spring")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices without a tuning electrode."""
        reason = super().unsuited(device, model)
        if reason or (isinstance(device, TwoAxis) and device.tuning is not None):
            return reason
        return "this device has no tuning electrode; give it device.electrodes.tuning, or take the plant gyroscope"

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the device and its plates."""
        p: TunedGyroscope.Packed = super().pack(params, context)
        device: Any = context.device
        p.per_v2, p.gap = device.tuning.per_v2, device.tuning.gap
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Advance over the interval that ends now, with the voltage held over it."""
        start(p, x)
        m = s.motion
        take_now(p.body, m, x)
        free = m.stiffness_y - m.stiffness_xy * m.stiffness_xy / m.stiffness_x
        m.stiffness_y -= p.per_v2 * x.tuning * x.tuning
        go(p.body, m, x, x.pilot)
        x.pulled_in = wins(p.per_v2 * x.tuning * x.tuning, free, abs(x.y) / p.gap)
        x.split = hertz(m.stiffness_y / m.mass_y) - hertz(m.stiffness_x / m.mass_x)


@kernel
def wins(taken: float, stiffness: float, share: float) -> float:
    """Return 1 where plates that take a stiffness away pull the mass in from a share of the gap, else 0."""
    if not taken < stiffness:
        return 1.0
    return 1.0 if share * share >= 1.0 - math.sqrt(max(taken, 0.0) / stiffness) else 0.0


@kernel
def hertz(square: float) -> float:
    """Return the frequency of a squared angular frequency in 1/ms^2, 0 without one."""
    return MS_PER_S * math.sqrt(max(square, 0.0)) / (2.0 * math.pi)
