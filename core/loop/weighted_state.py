"""The state of the device as a bank weighs it: the estimate of multiple-model adaptive estimation."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, Context, Equation
from core.diagnose.hypothesis import BankParams
from core.diagnose.lanes import LANE
from core.kernel import kernel
from core.loop.weighted_parameters import Models, ParameterErrors, ParameterPorts, weigh_parameters, with_factors
from core.ports import reads, tap
from core.record import Vector, vector


class WeightedState(Block):
    r"""Weighs the states of a bank's models by their probabilities (5.2.3.2, 5.3.1), with the covariance of a mixture.

    .. math:: \hat x=\sum_kp_k\hat x_k,\quad\hat y=H\hat x,\qquad
        P=\sum_kp_k\left[P_k+(\hat x_k-\hat x)(\hat x_k-\hat x)^T\right],\qquad\hat\theta=\sum_kp_k\theta_k

    This is the state with the least mean square error if one of the models is true and the probabilities are right
    (Lainiotis 1976). The covariance has two parts: the doubt of each model, and the distance between the models, which
    is large while the bank hesitates. A consistency test gives its candidates equal probabilities, so its weighted
    state is the state of the only candidate once it isolates a fault.

    The block also counts errors against the true motion, as a score counts verdicts. For each stretch with one true
    hypothesis it compares the weighted displacement with the best model among the false ones.
    """

    title = "Weighted state"
    equations = (
        Equation(
            "weighted state",
            r"\hat x(t_i)=\sum_kp_k(t_i)\,\hat x_k(t_i),\quad\hat y=H\hat x",
            "5.2.3.2",
            printed=r"\text{they can weight the outputs of the systems and define the weighted output of each "
            r"fault-model}",
            why="the text has no equation; a weighted output of each model is p_k y_k, and only the sum of these over "
            "all models is an estimate of the displacement",
        ),
        Equation(
            "covariance",
            r"P=\sum_kp_k\left[P_k+(\hat x_k-\hat x)(\hat x_k-\hat x)^T\right]",
            "Bar-Shalom, Li and Kirubarajan 2001, 1.4.16",
        ),
        Equation(
            "weights",
            r"\hat x=\sum_kp_k\hat x_k,\quad p_k\leftarrow\frac{p_kf_k}{\sum_jp_jf_j}",
            "5.3.1",
            printed=r"\text{residual signals are used to compute the weights applied to the estimated state space "
            r"variables}",
            why="residuals make the densities f_k, and the weights also depend on the weights before; a residual of "
            "one sample weighs hardly anything",
        ),
        Equation("parameters", r"\hat\theta=\sum_kp_k\theta_k", "5.2.3.2"),
    )
    Params = BankParams
    Packed = Models

    class State(ParameterErrors):
        """Sums of squared errors of displacement and velocity; the same of displacements in the present step.

        The truth of this step, the sum for the weighted displacement and for each model, and the largest ratio of all
        steps before.
        """

        displacement_square: float
        velocity_square: float
        truth: float
        step_square: float
        worst: float
        step_squares: Vector = vector(LANE)

    class Ports(ParameterPorts):
        """Also the states of the models and the true motion; the weighted state and its covariance."""

        state_displacement: Vector = reads("^state_displacement", "um", "displacements under the hypotheses")
        state_velocity: Vector = reads("^state_velocity", "um/ms", "velocities under the hypotheses")
        variance_displacement: Vector = reads("^variance_displacement", "um^2", "variances of these displacements")
        model_covariance: Vector = reads("^covariance", "um^2/ms", "covariances of displacement and velocity")
        variance_velocity: Vector = reads("^variance_velocity", "um^2/ms^2", "variances of these velocities")
        truth: float = reads("^truth", "1", "index of the true hypothesis, -1 for none")
        true_displacement: float = reads("plant.displacement", "um", "true displacement")
        true_velocity: float = reads("plant.velocity", "um/ms", "true velocity")
        displacement: float = tap("um", "displacement, weighted by the probabilities")
        velocity: float = tap("um/ms", "velocity, weighted by the probabilities")
        displacement_std: float = tap("um", "standard deviation of this displacement")
        velocity_std: float = tap("um/ms", "standard deviation of this velocity")
        covariance: float = tap("um^2/ms", "covariance of both")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Models:
        """Pack the factors of the hypotheses."""
        return with_factors(cls.Packed.blank(), params)

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Nothing counted."""
        s = cls.State.zeros()
        s.truth = -2.0
        return s

    @staticmethod
    def step(p: Models, s: State, x: Ports) -> None:
        """Weigh states and parameters, then compare with the truth."""
        n = int(p.count)
        weigh_parameters(p, s, x, n)
        displacement = 0.0
        velocity = 0.0
        for i in range(n):
            weight = x.probability[i]
            displacement += weight * x.state_displacement[i]
            velocity += weight * x.state_velocity[i]
        p11 = 0.0
        p12 = 0.0
        p22 = 0.0
        for i in range(n):
            weight = x.probability[i]
            d1 = x.state_displacement[i] - displacement
            d2 = x.state_velocity[i] - velocity
            p11 += weight * (x.variance_displacement[i] + d1 * d1)
            p12 += weight * (x.model_covariance[i] + d1 * d2)
            p22 += weight * (x.variance_velocity[i] + d2 * d2)
        x.displacement = displacement
        x.velocity = velocity
        x.displacement_std = math.sqrt(max(p11, 0.0))
        x.velocity_std = math.sqrt(max(p22, 0.0))
        x.covariance = p12
        if math.isfinite(displacement + velocity):
            compare(s, x, n)


@kernel
def compare(s: WeightedState.State, x: WeightedState.Ports, n: int) -> None:
    """Add the squared errors of a sample; where the truth changes, a new step begins."""
    e1 = x.displacement - x.true_displacement
    e2 = x.velocity - x.true_velocity
    s.displacement_square += e1 * e1
    s.velocity_square += e2 * e2
    if x.truth != s.truth:
        s.worst = max(s.worst, over_best_false(s, n))
        s.truth = x.truth
        s.step_square = 0.0
        for i in range(n):
            s.step_squares[i] = 0.0
    s.step_square += e1 * e1
    for i in range(n):
        error = x.state_displacement[i] - x.true_displacement
        s.step_squares[i] += error * error


@kernel
def over_best_false(s: WeightedState.State, n: int) -> float:
    """Return the rms error of the weighted displacement in this step over the error of the best false model."""
    least = math.inf
    for i in range(n):
        if i != s.truth:
            least = min(least, s.step_squares[i])
    return math.sqrt(s.step_square / least) if least > 0.0 else 0.0


def worst_step(s: WeightedState.State, n: int) -> float:
    """Return the largest of these ratios over all steps so far."""
    return float(max(s.worst, over_best_false(s, n)))
