"""Kalman bank that is given displacement and velocity."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation, Stage, parameter
from core.diagnose.filters import between_updates, driven, filters_step, show_states, take_logarithms
from core.diagnose.kalman import FILTERS, KalmanBank, KalmanParams
from core.diagnose.lanes import LANE, Filters
from core.diagnose.weights import floored, take_floored_softmax
from core.elementary import log
from core.kernel import kernel, whole
from core.ports import reads, tap
from core.record import Vector, vector
from core.voltage import observed


@kernel
def correct_velocity(s: Filters, i: int, residual: float, psi: float) -> tuple[float, float]:
    """Correct one filter by the velocity, after the displacement; return its gain."""
    c12 = s.p12[i]
    c22 = s.p22[i]
    k1 = c12 / psi
    k2 = c22 / psi
    s.x1[i] += k1 * residual
    s.x2[i] += k2 * residual
    s.p11[i] -= k1 * c12
    s.p12[i] = c12 - k1 * c22
    s.p22[i] = c22 - k2 * c22
    return k1, k2


class TwoOutput(KalmanBank):
    r"""The bank with C = I, equation 5.2.4: both states are measured.

    .. math:: z=\begin{bmatrix}y\\ \dot y\end{bmatrix}+v,\quad \psi=P^-+R,\quad
        p_k\leftarrow p_k\,\frac{e^{-r_k^T\psi_k^{-1}r_k/2}}{|\psi_k|^{1/2}}

    The noises of the two outputs are independent, so correcting by one after the other gives the same state and the
    same likelihood as correcting by both at once.
    """

    sample_by_sample = False
    title = "Kalman bank, displacement and velocity"
    equations = (
        Equation(
            "likelihood",
            r"f_k=\frac{e^{-r_k^T\psi_k^{-1}r_k/2}}{2\pi|\psi_k|^{1/2}}",
            "5.2.3.2.3",
            printed=r"\beta_k=(2\pi)^{-l/2}|\psi_k|^{-l/2}",
            why="the determinant is to the power one half, whatever the number of outputs; the same only for one",
        ),
    )
    structure = (
        FILTERS,
        Stage(
            "Correction by the velocity",
            "velocity residual",
            "velocity_residual",
            ("likelihood",),
        ),
        Stage("Likelihoods", "log nis covariance velocity_residual", "likelihood", ("likelihood",)),
        Stage("Weights", "likelihood", "log probability"),
    )

    class Params(KalmanParams):
        """Assumptions of the Kalman filters, and parameters of this bank."""

        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        velocity_noise_um_ms: float | None = parameter(
            None, "assumed noise of the velocity; the velocimeter's own unless given", "um/ms", gt=0, le=1e4
        )

    class Packed(KalmanBank.Packed):
        """Parameters of the filters; floor under probabilities and its logarithm, variance of a measured velocity."""

        probability_floor: float
        log_floor: float
        velocity_noise: float

    class State(KalmanBank.State):
        """The filters; logarithms of probabilities, and the logarithms of this sample."""

        log: Vector = vector(LANE)
        likelihood: Vector = vector(LANE)

    class Ports(KalmanBank.Ports):
        """Ports of every bank, and the velocity."""

        velocity: float = reads("velocimeter.velocity", "um/ms", "measured velocity")
        velocity_residual: Vector = tap("um/ms", "measured velocity minus that expected by then", each="hypotheses")
        velocity_gain_displacement: Vector = tap(
            "ms", "Kalman gain of the displacement by the measured velocity", each="hypotheses"
        )
        velocity_gain_velocity: Vector = tap(
            "1", "Kalman gain of the velocity by the measured velocity", each="hypotheses"
        )

    @classmethod
    def floor(cls, params: Any) -> float:
        """Return the smallest probability."""
        return float(params.probability_floor)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        known = getattr(context.sensors.get("velocimeter"), "noise_um_ms", 0.0)
        velocity = max(params.velocity_noise_um_ms or known, 1e-3)
        p = cls.filters(cls.Packed.blank(), params, context)
        p.probability_floor, p.log_floor = floored(params.probability_floor)
        p.velocity_noise = velocity * velocity * params.assumed_noise_scale
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """All filters at zero, all hypotheses alike."""
        s = cls.at_rest(cls.State.zeros(), params, context)
        s.log[:] = -log(len(params.hypotheses))
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Predict, correct by one output and then by the other, weigh."""
        n = int(p.count)
        if between_updates(p, s, x, 0, whole(n)):
            return
        zv = x.velocity
        seen = math.isfinite(observed(x))
        seen_too = math.isfinite(zv)
        drive = driven(p, s)
        if filters_step(p, s, x, n):
            take_logarithms(s, n)
        best = -math.inf
        for i in range(n):
            nis = s.nis[i]
            likelihood = s.log[i]
            if seen and drive:
                likelihood += -0.5 * nis - s.half_log[i]
            residual = 0.0
            if seen_too:
                psi = s.p22[i] + p.velocity_noise
                residual = zv - s.x2[i]
                square = residual * residual / psi
                k1, k2 = correct_velocity(s, i, residual, psi)
                x.velocity_gain_displacement[i] = k1
                x.velocity_gain_velocity[i] = k2
                if drive:
                    likelihood += -0.5 * square - 0.5 * log(psi)
                nis = 0.5 * (nis + square) if seen else square
            x.velocity_residual[i] = residual
            x.nis[i] = nis
            s.likelihood[i] = likelihood
            best = max(best, likelihood)
        show_states(p, s, x, n)
        take_floored_softmax(s.log, s.likelihood, x.probability, n, best, p.probability_floor, p.log_floor)
