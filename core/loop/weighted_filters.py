"""The state and the parameter of the device as a moving bank weighs its three filters."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, Context, Equation
from core.diagnose.moving_bank import MovingBank
from core.loop.mixture import MixturePorts, MotionErrors, compare_motion, mix
from core.loop.weighted_parameters import compare_parameters
from core.ports import reads
from core.record import Choice, Record

FOLLOWED = ("mass", "stiffness", "damping", "gain")
"""Parameters that a moving bank may follow, in the order of their numbers."""


class WeightedFilters(Block):
    r"""Weighs the states of the three filters of a moving bank, with the covariance of a mixture.

    .. math:: \hat x=\sum_kp_k\hat x_k,\qquad P=\sum_kp_k\left[P_k+(\hat x_k-\hat x)(\hat x_k-\hat x)^T\right]

    The weighted value of the parameter that is followed is the estimate of the bank; the others are nominal. The
    filters are no hypotheses about the device, and there is no false model for a comparison of the errors.
    """

    title = "Weighted filters"
    equations = (
        Equation("weighted state", r"\hat x=\sum_kp_k\hat x_k", "5.2.3.2 for the filters of Maybeck and Hentz 1987"),
        Equation(
            "covariance",
            r"P=\sum_kp_k\left[P_k+(\hat x_k-\hat x)(\hat x_k-\hat x)^T\right]",
            "Bar-Shalom, Li and Kirubarajan 2001, 1.4.16",
        ),
    )
    Params = MovingBank.Params
    State = MotionErrors

    class Packed(Record):
        """Which parameter is followed."""

        follows: Choice

    class Ports(MixturePorts):
        """Also the estimate of the bank."""

        estimate: float = reads("^estimate", "1", "estimated factor on the parameter")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack which parameter is followed."""
        p = cls.Packed.blank()
        p.follows = FOLLOWED.index(params.follows)
        return p

    @staticmethod
    def step(p: Packed, s: MotionErrors, x: Ports) -> None:
        """Weigh the states, show the parameter, then compare with the truth."""
        x.mass = x.estimate if p.follows == 0.0 else 1.0
        x.stiffness = x.estimate if p.follows == 1.0 else 1.0
        x.damping = x.estimate if p.follows == 2.0 else 1.0
        x.gain = x.estimate if p.follows == 3.0 else 1.0
        compare_parameters(s, x)
        mix(x, 3)
        if math.isfinite(x.displacement + x.velocity):
            compare_motion(s, x)
