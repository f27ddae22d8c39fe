"""Constant rate with the noise of a gyroscope."""

from __future__ import annotations

from core.block import Equation, parameter
from core.rate.constant import ConstantRate
from core.rate.generator import NOISE


class Noise(ConstantRate):
    r"""Constant rate with noise of the tactical grade, :math:`\Omega(t)=\Omega_0+\Omega_n`.

    The usual figures cross where a record of a few minutes shows them: white noise and floor at 9 s, floor and random
    walk at 430 s.
    """

    title = "Constant rate with noise"
    equations = (Equation("rate", r"\Omega(t)=\Omega_0+\Omega_n"), NOISE)

    class Params(ConstantRate.Params):
        """The rate, and noise to begin with."""

        angle_random_walk_deg_rt_h: float = parameter(
            0.1, "angle random walk N", "deg/rt h", equation="noise", ge=0, le=1e6
        )
        bias_instability_deg_h: float = parameter(3.0, "bias instability B", "deg/h", equation="noise", ge=0, le=1e9)
        rate_random_walk_deg_h_rt_h: float = parameter(
            10.0, "rate random walk K", "deg/h/rt h", equation="noise", ge=0, le=1e9
        )
