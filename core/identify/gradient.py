"""Gradient identifier."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, Stage, parameter
from core.identify.filtered import (
    FilteredEstimator,
    FilteredParams,
    N,
    bounds,
    follow_voltage,
    observe,
    prediction,
    report,
)
from core.identify.identifier import DEVICE, JUDGED, between_updates, coefficients


class Gradient(FilteredEstimator):
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
            why="V is constant for any parameter error that this input does not show: only persistent excitation "
            "makes the parameters converge",
        ),
    )
    structure = (
        Stage("Filters", "applied measured", "phi", ("model",)),
        Stage("Residual", "coefficient phi measured", "residual", ("model",)),
        Stage("Estimator", "residual phi", "coefficient", ("law", "Lyapunov function")),
        DEVICE,
        JUDGED,
    )

    class Params(FilteredParams):
        """Gains, in um, V and 1/w0."""

        adaptation_gain: float = parameter(1.0, "adaptation gain g", equation="3.2.3.7", gt=0, le=1e3)
        output_weight: float | None = parameter(
            None, "weight of a1 and a2 in Gamma; 1/kp^2 unless given, so that y counts in volts", "V^2/um^2", gt=0
        )
        normalise: bool = parameter(True, "divide by 1 + phi'G phi; off as printed")

    class Packed(FilteredEstimator.Packed):
        """Adaptation gain, weight of a1 and a2 in Gamma, whether the law is normalised."""

        adaptation_gain: float
        output_weight: float
        normalise: float

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        gain = coefficients(context.device)[0]
        p = cls.Packed.blank()
        cls.fill_nominal(p, params, context)
        p.output_weight = 1.0 / gain**2 if params.output_weight is None else params.output_weight
        return p

    @staticmethod
    def step(p: Packed, s: FilteredEstimator.State, x: FilteredEstimator.Ports) -> None:
        """Filter, compare, move down the gradient."""
        follow_voltage(p, s, x)
        if between_updates(p, x):
            return
        seen, z = observe(p, s, x)
        e = z - prediction(s)
        if seen and p.enabled != 0.0:
            den = 1.0
            if p.normalise != 0.0:
                for i in range(N):
                    den += (1.0 if i == 0 else p.output_weight) * s.phi[i] * s.phi[i]
            rate = p.h * p.adaptation_gain * e / den
            for i in range(N):
                theta = s.theta[i] + (1.0 if i == 0 else p.output_weight) * rate * s.phi[i]
                if p.range_ratio > 0.0:
                    low, high = bounds(p, i)
                    theta = min(max(theta, low), high)
                s.theta[i] = theta
        report(p, s, x, e)
