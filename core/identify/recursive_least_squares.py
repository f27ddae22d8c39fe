"""Recursive least squares with a forgetting factor."""

from __future__ import annotations

from core.block import Equation, Stage, parameter
from core.estimation import estimate, trace_of
from core.identify.discrete import Discrete, DiscreteParams, N, gather_voltage, observe, report, restart
from core.identify.identifier import DEVICE, JUDGED, between_updates


class RecursiveLeastSquares(Discrete):
    r"""Recursive least squares with a forgetting factor, FFRLS (5.3.3.6-9).

    .. math:: K=\frac{\eta h}{\lambda+h^T\eta h},\quad\hat\theta\leftarrow\hat\theta+K(z-h^T\hat\theta),\quad
        \eta\leftarrow\frac{\eta-Kh^T\eta}{\lambda},\quad h=[u_{i-1},u_{i-2},-z_{i-1},-z_{i-2}]

    It minimises :math:`\sum\lambda^{n-i}(z_i-h_i^T\theta)^2`: a memory of about :math:`1/(1-\lambda)` samples. Only a
    triangle of the covariance is kept, since the antisymmetric part of its rounding would grow as :math:`\lambda^{-i}`.
    Its trace is limited, since it grows in the same way without excitation. Sensor noise
    in the regressor biases the estimate, the more so the faster it samples: run it at 10 to 20 kHz.
    """

    title = "Recursive least squares (FFRLS)"
    equations = (
        Equation("model", r"z_{i+1}=h_i^T\theta,\quad\theta=[b_0,b_1,a_1,a_2]^T", "5.3.3.1-4"),
        Equation(
            "estimate", r"\hat\theta\leftarrow\hat\theta+\frac{\eta h}{\lambda+h^T\eta h}(z-h^T\hat\theta)", "5.3.3.8"
        ),
        Equation(
            "covariance",
            r"\eta\leftarrow\frac1\lambda\left(\eta-\frac{\eta hh^T\eta}{\lambda+h^T\eta h}\right)",
            "5.3.3.9",
        ),
        Equation(
            "memory",
            r"n=\frac1{1-\lambda}",
            "5.3.4",
            printed=r"\text{a higher forgetting factor: a short history}",
            why="backwards: 7, 10 and 50 samples at 0.86, 0.9 and 0.98",
        ),
    )
    structure = (
        Stage("Regressor", "applied measured", "phi", ("model",)),
        Stage("Residual", "coefficient phi measured", "residual", ("estimate",)),
        Stage("Covariance", "phi", "covariance covariance_trace", ("covariance", "memory")),
        Stage("Estimator", "residual phi covariance", "coefficient", ("estimate",)),
        DEVICE,
        JUDGED,
    )

    class Params(DiscreteParams):
        """Forgetting, trust and safeguards, in um and V."""

        forgetting: float = parameter(0.98, "forgetting factor", "1", equation="5.3.3.8", gt=0, le=1)
        dead_zone_um: float = parameter(0.0, "residual below which nothing is learnt", "um", ge=0, le=100)
        reset_below: float = parameter(0.0, "trace below which the covariance starts anew, 0 for never", ge=0, le=1e15)

    class Packed(Discrete.Packed):
        """Forgetting factor, dead zone, trace below which the covariance starts anew."""

        forgetting: float
        dead_zone_um: float
        reset_below: float

    @staticmethod
    def step(p: Packed, s: Discrete.State, x: Discrete.Ports) -> None:
        """Predict, compare, update estimate and covariance."""
        gather_voltage(p, s, x)
        if between_updates(p, x):
            return
        use, e = observe(p, s, x)
        if use and abs(e) >= p.dead_zone_um:
            estimate(s.theta, s.covariance, s.phi, s.product, N, e, p.forgetting, p.forgetting, p.covariance_limit)
            if p.reset_below > 0.0 and trace_of(s.covariance, N) < p.reset_below:
                restart(p, s)
        report(p, s, x, e)
