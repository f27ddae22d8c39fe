"""Motion, rate and parameters of a device with two axes as a bank weighs them."""

from __future__ import annotations

import math
from typing import Any, cast

from core.block import Block, Context, Equation
from core.device.two_axis import TwoAxis
from core.diagnose.axes_hypothesis import AxesModels
from core.diagnose.lanes import LANE
from core.kernel import kernel
from core.loop.step_errors import StepErrors, begin_step
from core.loop.weighted_parameters import PARTS, Models, ParameterErrors, ParameterPorts, weigh_parameters
from core.ports import reads, tap
from core.record import Vector, vector
from core.units import rate_rad_ms


class WeightedAxes(Block):
    r"""Weighs motion and rate of a bank of two axes by their probabilities, with the variances of a mixture.

    .. math:: \hat x=\sum_kp_k\hat x_k,\quad\hat\Omega=\sum_kp_k\hat\Omega_k,\qquad
        P_{ii}=\sum_kp_k\left[P_{k,ii}+(\hat x_{k,i}-\hat x_i)^2\right],\qquad\hat\theta=\sum_kp_k\theta_k

    Each model estimates a rate of its own; their weighted sum is the rate that the bank measures, whatever the fault.
    The variance of a model is :math:`P_k=P_{0,k}+V_kM_kV_k^T`, the steady covariance for a known rate and the doubt of
    the rate (`core.diagnose.axes_filter`). Models that are far from the true one count with the smallest probability: a
    floor of 1e-6 makes the standard deviation of x five times the error where the quality factor is 2000.

    The block also counts errors against the true motion, rate and parameters. In each stretch with one true hypothesis
    the squares of both displacements together are compared with the best model among the false ones.
    """

    title = "Weighted axes"
    axes = ("x", "y")
    equations = (
        Equation(
            "weighted state",
            r"\hat x(t_i)=\sum_kp_k(t_i)\,\hat x_k(t_i),\quad\hat\Omega=\sum_kp_k\hat\Omega_k",
            "5.2.3.2 for the plant of 6.1",
        ),
        Equation(
            "variances",
            r"P_{ii}=\sum_kp_k\left[P_{0,k,ii}+V_{k,i}^2M_k+(\hat x_{k,i}-\hat x_i)^2\right]",
            "Bar-Shalom, Li and Kirubarajan 2001, 1.4.16; Friedland 1969",
        ),
        Equation("parameters", r"\hat\theta=\sum_kp_k\theta_k", "5.2.3.2"),
    )
    Params = AxesModels

    class Packed(Models):
        """Also the factors of two axes, and the rate in deg/s as which a stiffness between the axes reads."""

        second_stiffness: Vector = vector(LANE)
        quadrature: Vector = vector(LANE)
        dps: float

    class State(ParameterErrors, StepErrors):
        """Also sums of squared errors of displacements, rate, second stiffness and quadrature."""

        x_square: float
        y_square: float
        rate_square: float
        second_stiffness: float
        quadrature: float

    class Ports(ParameterPorts):
        """Also motion and rate under the hypotheses and the true ones; the weighted ones."""

        state_x: Vector = reads("^state_x", "um", "displacements along x under the hypotheses")
        state_y: Vector = reads("^state_y", "um", "displacements along y under the hypotheses")
        state_x_velocity: Vector = reads("^state_x_velocity", "um/ms", "velocities along x under the hypotheses")
        state_y_velocity: Vector = reads("^state_y_velocity", "um/ms", "velocities along y under the hypotheses")
        model_rate: Vector = reads("^rate", "deg/s", "rates under the hypotheses")
        variance_x: Vector = reads("^variance_x", "um^2", "variances of the displacements along x")
        variance_y: Vector = reads("^variance_y", "um^2", "variances of the displacements along y")
        variance_x_velocity: Vector = reads("^variance_x_velocity", "um^2/ms^2", "variances of the velocities along x")
        variance_y_velocity: Vector = reads("^variance_y_velocity", "um^2/ms^2", "variances of the velocities along y")
        variance_rate: Vector = reads("^variance_rate", "deg^2/s^2", "variances of the rates")
        truth: float = reads("^truth", "1", "index of the true hypothesis, -1 for none")
        second_stiffness_scale: float = reads(
            "effects.second_stiffness_scale", "1", "true stiffness of the second axis over the stiffness of all"
        )
        cross_stiffness: float = reads("effects.cross_stiffness", "uN/um", "true stiffness added between the axes")
        true_x: float = reads("plant.x", "um", "true displacement along x")
        true_y: float = reads("plant.y", "um", "true displacement along y")
        true_rate: float = reads("rate.rate", "deg/s", "true rate")
        second_stiffness: float = tap("1", "stiffness along y beside the change of both, weighted")
        quadrature: float = tap("deg/s", "stiffness added between the axes, read as a rate, weighted")
        x: float = tap("um", "displacement along x, weighted by the probabilities")
        y: float = tap("um", "displacement along y, weighted by the probabilities")
        x_velocity: float = tap("um/ms", "velocity along x, weighted by the probabilities")
        y_velocity: float = tap("um/ms", "velocity along y, weighted by the probabilities")
        rate: float = tap("deg/s", "rate, weighted by the probabilities")
        x_std: float = tap("um", "standard deviation of the displacement along x")
        y_std: float = tap("um", "standard deviation of the displacement along y")
        x_velocity_std: float = tap("um/ms", "standard deviation of the velocity along x")
        y_velocity_std: float = tap("um/ms", "standard deviation of the velocity along y")
        rate_std: float = tap("deg/s", "standard deviation of the rate")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the factors of the hypotheses."""
        p = cls.Packed.blank()
        n = p.count = len(params.hypotheses)
        for part in (*PARTS, "second_stiffness"):
            getattr(p, part)[:n] = [getattr(item, part) for item in params.hypotheses]
        p.gain[:n] = [item.drive_gain for item in params.hypotheses]
        p.quadrature[:n] = [item.quadrature_dps for item in params.hypotheses]
        p.dps = 1.0 / cast(TwoAxis, context.device).cross_stiffness(rate_rad_ms(1.0))
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Nothing counted."""
        s = cls.State.zeros()
        s.truth = -2.0
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Weigh motion, rate and parameters, then compare with the truth."""
        n = int(p.count)
        weights = x.probability
        weigh_parameters(p, s, x, n)
        x.second_stiffness = mean(weights, p.second_stiffness, n)
        x.quadrature = mean(weights, p.quadrature, n)
        x.x = mean(weights, x.state_x, n)
        x.y = mean(weights, x.state_y, n)
        x.x_velocity = mean(weights, x.state_x_velocity, n)
        x.y_velocity = mean(weights, x.state_y_velocity, n)
        x.rate = mean(weights, x.model_rate, n)
        x.x_std = deviation(weights, x.state_x, x.variance_x, x.x, n)
        x.y_std = deviation(weights, x.state_y, x.variance_y, x.y, n)
        x.x_velocity_std = deviation(weights, x.state_x_velocity, x.variance_x_velocity, x.x_velocity, n)
        x.y_velocity_std = deviation(weights, x.state_y_velocity, x.variance_y_velocity, x.y_velocity, n)
        x.rate_std = deviation(weights, x.model_rate, x.variance_rate, x.rate, n)
        if math.isfinite(x.x + x.y + x.rate):
            compare_axes(p, s, x, n)


@kernel
def mean(weights: Vector, values: Vector, n: int) -> float:
    """Return the mean of a mixture."""
    total = 0.0
    for i in range(n):
        total += weights[i] * values[i]
    return float(total)


@kernel
def deviation(weights: Vector, values: Vector, variances: Vector, centre: float, n: int) -> float:
    """Return the standard deviation of a mixture around its mean."""
    total = 0.0
    for i in range(n):
        off = values[i] - centre
        total += weights[i] * (variances[i] + off * off)
    return math.sqrt(max(total, 0.0))


@kernel
def compare_axes(p: WeightedAxes.Packed, s: WeightedAxes.State, x: WeightedAxes.Ports, n: int) -> None:
    """Add the squared errors of a sample; where the truth changes, a new step begins."""
    ex = x.x - x.true_x
    ey = x.y - x.true_y
    rate = x.rate - x.true_rate
    second = x.second_stiffness - x.second_stiffness_scale
    quadrature = x.quadrature - p.dps * x.cross_stiffness
    s.x_square += ex * ex
    s.y_square += ey * ey
    s.rate_square += rate * rate
    s.second_stiffness += second * second
    s.quadrature += quadrature * quadrature
    begin_step(s, x.truth, n)
    s.step_square += ex * ex + ey * ey
    for i in range(n):
        along = x.state_x[i] - x.true_x
        across = x.state_y[i] - x.true_y
        s.step_squares[i] += along * along + across * across
