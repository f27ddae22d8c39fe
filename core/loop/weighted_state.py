"""The state of the device as a bank weighs it: the estimate of multiple-model adaptive estimation."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, Context, Equation
from core.diagnose.hypothesis import BankParams
from core.kernel import kernel
from core.loop.mixture import MixturePorts, MotionErrors, compare_motion, mix
from core.loop.step_errors import StepErrors, begin_step
from core.loop.weighted_parameters import Models, weigh_parameters, with_factors
from core.ports import reads


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

    class State(MotionErrors, StepErrors):
        """Sums of squared errors, over all samples and in the present step."""

    class Ports(MixturePorts):
        """Also the true hypothesis."""

        truth: float = reads("^truth", "1", "index of the true hypothesis, -1 for none")

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
        mix(x, n)
        if math.isfinite(x.displacement + x.velocity):
            compare(s, x, n)


@kernel
def compare(s: WeightedState.State, x: WeightedState.Ports, n: int) -> None:
    """Add the squared errors of a sample; where the truth changes, a new step begins."""
    square = compare_motion(s, x)
    begin_step(s, x.truth, n)
    s.step_square += square
    for i in range(n):
        error = x.state_displacement[i] - x.true_displacement
        s.step_squares[i] += error * error
