"""Gradient identifier."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, parameter
from core.identify.filtered import (
    OWN_P,
    PHI,
    RANGE,
    THETA,
    Filtered,
    FilteredParams,
    bounds,
    gathers,
    observe,
    report,
)
from core.identify.identifier import ENABLED, H, coefficients

GAIN, OUTPUT_WEIGHT, NORMALISE = range(OWN_P, OWN_P + 3)


def gradient_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Filter, compare, move down the gradient."""
    if gathers(p, s, w, io):
        return
    seen, e = observe(p, s, w, io)
    if seen and p[ENABLED] != 0.0:
        den = 1.0
        if p[NORMALISE] != 0.0:
            for i in range(3):
                den += (1.0 if i == 0 else p[OUTPUT_WEIGHT]) * s[PHI + i] * s[PHI + i]
        rate = p[H] * p[GAIN] * e / den
        for i in range(3):
            theta = s[THETA + i] + (1.0 if i == 0 else p[OUTPUT_WEIGHT]) * rate * s[PHI + i]
            if p[RANGE] > 0.0:
                low, high = bounds(p, i)
                theta = min(max(theta, low), high)
            s[THETA + i] = theta
    report(p, s, w, io, e)


class Gradient(Filtered):
    r"""Gradient identifier of :math:`\theta=[k_p,a_1,a_2]` (3.2.3.2-7).

    .. math:: \dot{\hat\theta}=-\frac{g\,\Gamma\varphi e_1}{1+\varphi^T\Gamma\varphi},\quad
        e_1=\hat\theta^T\varphi-z,\quad \varphi=\frac{1}{(s+\lambda)^2}[u,-\dot y,-y]^T,\; z=\frac{s^2}{(s+\lambda)^2}y

    The error goes to zero whatever the input; the parameters follow only under persistent excitation, which two tones
    give and one does not.
    """

    title = "Gradient identifier"
    equations = (
        Equation("model", r"z=\theta^T\varphi,\quad\theta=[k_p,a_1,a_2]^T", "3.2.3.2-4, 3.3.2.6-7"),
        Equation(
            "law",
            r"\dot{\hat\theta}=-g\,\Gamma\frac{\varphi e_1}{1+\varphi^T\Gamma\varphi},\quad e_1=\hat y-y",
            "3.2.3.7",
            printed=r"\hat\theta=-P_0we_1",
            why="the dot is lost; and without the normaliser the gain that is stable depends on the amplitude",
        ),
        Equation(
            "Lyapunov function",
            r"V=\tilde\theta^TP_0^{-1}\tilde\theta,\quad\dot V=-2e_1^2\le0",
            "3.2.3.8-9",
            printed=r"\dot V<0",
            why="V stands still for any parameter error that this input does not show: only persistent excitation "
            "makes the parameters converge",
        ),
    )

    class Params(FilteredParams):
        """Gains, in um, V and 1/w0."""

        adaptation_gain: float = parameter(1.0, "adaptation gain g", equation="3.2.3.7", gt=0, le=1e3)
        output_weight: float | None = parameter(
            None, "weight of a1 and a2 in Gamma; 1/kp^2 unless given, so that y counts in volts", "V^2/um^2", gt=0
        )
        normalise: bool = parameter(True, "divide by 1 + phi'G phi; off as printed")

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        gain = coefficients(context.device)[0]
        weight = 1.0 / gain**2 if params.output_weight is None else params.output_weight
        own = [params.adaptation_gain, weight, float(params.normalise)]
        return np.array(cls.filters(params, context) + own)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Start with filters at rest, and the estimate at the start."""
        return cls.begin(params, context)

    step = gradient_step
