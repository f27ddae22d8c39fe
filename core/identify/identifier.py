r"""What every identifier shares: ports, the truth beside the estimate, excitation.

Displacement is in um, voltage in V and time in units of :math:`1/\omega_0`, the unit of :math:`\theta=[k_p,a_1,a_2]` of
:math:`\ddot y+a_1\dot y+a_2y=k_pu`. Outputs are mass, stiffness and damping over their nominal values, the force per
volt taken as known.
"""

from __future__ import annotations

import math
from typing import Any, ClassVar

from core.block import TICK, Block, BlockParams, Context, Oscillator, Port, kernel, parameter
from core.theory.persistency import gather, smallest_eigenvalue
from core.voltage import APPLIED_PORTS

MEASURED, APPLIED = range(2)
MASS_SCALE, STIFFNESS_SCALE, DAMPING_SCALE, DRIVE_GAIN, OWN_PORT = (APPLIED + len(APPLIED_PORTS) + n for n in range(5))
INPUTS = (
    Port("measured", "um", "measured displacement", source="sensor.displacement"),
    *APPLIED_PORTS,
    Port("mass_scale", "1", "true mass over nominal", source="effects.mass_scale"),
    Port("stiffness_scale", "1", "true stiffness over nominal", source="effects.stiffness_scale"),
    Port("damping_scale", "1", "true damping over nominal", source="effects.damping_scale"),
    Port("drive_gain", "1", "voltage at the comb over voltage applied", source="effects.drive_gain"),
)
PHYSICAL = ("mass", "stiffness", "damping")
ESTIMATE = Port("estimate", "1", "estimated mass, stiffness and damping over nominal", labels=PHYSICAL)
TRUTH = Port("truth", "1", "true mass, stiffness and damping over nominal", labels=PHYSICAL)
ERROR = Port("error_pct", "%", "largest relative error of the estimated coefficients")
EXCITATION = (
    Port("excitation", "mixed", "smallest eigenvalue of the mean of phi phi' over the last window, less noise"),
    Port("excitation_relative", "1", "the same with every component of phi scaled to a unit mean square"),
    Port("identifiable", "1", "1 while this input tells all parameters apart"),
)

WINDOW, LEAST, H, EVERY, ENABLED, OWN_PARAMETER = range(6)
"""Packed parameters of every identifier: ticks of a window, least relative excitation, interval in 1/w0, ticks."""

BAD_PCT = 1e4
"""Error shown for an estimate that makes no sense."""


class ExcitationParams(BlockParams):
    """How the excitation is judged."""

    excitation_window_ms: float = parameter(
        20.0, "window of the excitation", "ms", equation="A.9.1", gt=0, le=1e6, live=False
    )
    least_excitation: float = parameter(
        1e-5, "least relative excitation that counts as identifiable", "1", equation="A.9.1", ge=0, le=1
    )


class IdentifierParams(ExcitationParams):
    """Parameters of every identifier."""

    enabled: bool = parameter(True, "go on estimating; off holds the estimate, and on again trusts it no longer")


class Identifier(Block):
    """Base of every identifier."""

    inputs: ClassVar[tuple[Port, ...]] = INPUTS
    every_tick: ClassVar[bool] = True

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants without mass, damping or spring."""
        whole = min(device.mass, device.damping, device.stiffness) > 0.0
        return "" if whole else "needs a device with mass, damping and spring"

    @classmethod
    def shared(cls, params: Any, context: Context) -> list[float]:
        """Pack what every identifier needs."""
        return [
            float(max(1, round(params.excitation_window_ms / context.dt_ms))),
            params.least_excitation,
            context.dt_ms * context.device.natural_frequency,
            float(context.every),
            float(getattr(params, "enabled", True)),
        ]


def coefficients(device: Oscillator) -> tuple[float, float, float]:
    """Return kp, a1 and a2 of a device, in um, V and 1/w0; without stators to pull kp is 1."""
    w = device.natural_frequency
    mass = device.mass
    return (device.force / (mass * w * w)) or 1.0, device.damping / (mass * w), device.stiffness / (mass * w * w)


@kernel
def between_turns(p: Any, w: Any) -> bool:
    """Say whether an identifier that runs every N ticks only takes in the voltage of this one."""
    return bool(p[EVERY] != 1.0 and w[TICK] % p[EVERY] != 0.0)


@kernel
def excite(p: Any, noise: int, s: Any, gram: int, regressor: int, n: int, w: Any, io: Any, first: int) -> None:
    """Gather the Gram matrix and judge it at the end of each window, less twice what noise of the sensor adds to it.

    Noise turns the regressor in every direction and tells nothing; taken away once, half of the windows would still
    show some of it. A count, the lower triangle, n^2 scratch numbers and the last verdict stand from ``gram`` on, the
    lower triangle of the mean noise from ``noise`` on. The three ports of ``EXCITATION`` begin at ``first``.
    """
    gather(s, gram + 1, regressor, n)
    s[gram] += 1.0
    size = n * (n + 1) // 2
    scratch = gram + 1 + size
    judged = scratch + n * n
    if s[gram] >= p[WINDOW]:
        for i in range(size):
            s[gram + 1 + i] -= 2.0 * s[gram] * p[noise + i]
        s[judged] = smallest_eigenvalue(s, gram + 1, scratch, n, False) / s[gram]
        s[judged + 1] = smallest_eigenvalue(s, gram + 1, scratch, n, True)
        for i in range(size + 1):
            s[gram + i] = 0.0
    w[io[first]] = s[judged]
    w[io[first + 1]] = s[judged + 1]
    w[io[first + 2]] = 1.0 if s[judged + 1] > p[LEAST] else 0.0


def room(n: int) -> int:
    """Return the numbers ``excite`` needs."""
    return 1 + n * (n + 1) // 2 + n * n + 2


@kernel
def show_truth(w: Any, io: Any, port: int) -> None:
    """Write mass, stiffness and damping as they are."""
    at = io[port]
    w[at] = w[io[MASS_SCALE]]
    w[at + 1] = w[io[STIFFNESS_SCALE]]
    w[at + 2] = w[io[DAMPING_SCALE]]


@kernel
def worst(s: Any, theta: int, w: Any, true: int, n: int) -> float:
    """Return the largest relative error of n coefficients, %."""
    largest = 0.0
    for i in range(n):
        value = abs(s[theta + i] / w[true + i] - 1.0)
        if not math.isfinite(value):
            return BAD_PCT
        largest = max(largest, value)
    return min(100.0 * largest, BAD_PCT)
