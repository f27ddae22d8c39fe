r"""LQG: a Kalman filter and a quadratic regulator about the motion of the model."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, Equation, FloatArray, Oscillator, Stage, parameter
from core.control.controller import unsuited_second_order
from core.control.nominal import Following, FollowingPorts, KnownParams, followed, following, known, over_sample
from core.errors import InputError
from core.kernel import flush_tiny, kernel
from core.matrix import product, riccati, solved
from core.ports import tap
from core.record import Record, Vector, vector
from core.voltage import Motion, Tick, add_moves, advance_motion, moves


class LqgParams(BlockParams):
    """The cost of the voltage, and the assumed noise."""

    voltage_cost_um_v: float = parameter(0.03, "root of the cost of a volt", "um/V", ge=1e-6, le=1e3)
    process_noise_v: float = parameter(1.0, "assumed noise on the voltage, rms per sample", "V", ge=1e-6, le=100)
    sensor_noise_um: float | None = parameter(
        None, "assumed sensor noise; the sensor's own unless given", "um", ge=1e-6, le=100
    )


class LqgLaw(Record):
    """The device over a sample, the voltage of the model's motion, gains of the regulator and of the filter."""

    device: Tick
    following: Following
    regulate: Vector = vector(2)
    correct: Vector = vector(2)


def fill_law(p: LqgLaw, device: Oscillator, params: LqgParams, context: Context) -> None:
    """Pack a device, and the gains of both Riccati equations."""
    p.device, p.following = over_sample(device, context), following(device, context.model)
    phi = np.array([[p.device.phi11, p.device.phi12], [p.device.phi21, p.device.phi22]])
    push, seen = np.array([[p.device.push1], [p.device.push2]]), np.array([[1.0, 0.0]])
    p.regulate[:] = gains(phi.T, push.T, product(seen.T, seen), params.voltage_cost_um_v**2, shift=True)
    noise_um = params.sensor_noise_um or context.assumed_noise_um
    p.correct[:] = gains(phi, seen, product(push, push.T) * params.process_noise_v**2, noise_um**2)


@kernel
def regulated(p: LqgLaw, s: Motion, x: FollowingPorts) -> float:
    """Predict by the voltage applied, correct by the measurement; return the voltage about the motion of the model."""
    u, middle, end = moves(x)
    advance_motion(p.device, s, u)
    add_moves(p.device, s, middle, end)
    missed = x.measured - s.x
    if math.isfinite(missed):
        s.x = flush_tiny(s.x + p.correct[0] * missed)
        s.v = flush_tiny(s.v + p.correct[1] * missed)
    behind: float = p.regulate[0] * (s.x - x.model) + p.regulate[1] * (s.v - x.model_velocity)
    return followed(p.following, x) - behind


class Lqg(Block):
    r"""Linear-quadratic-Gaussian tracking of the reference model (Kalman 1960; Åström 1970, chapter 8).

    .. math:: u=u_m-K(\hat x-x_m),\qquad \hat x=\bar x+L(y-C\bar x),\quad\bar x=\Phi\hat x+\Gamma u

    The filter takes the drive as it was applied, so that it also estimates in shadow and at the limit of the drive.
    """

    title = "LQG"
    place = 3
    equations = (
        Equation("law", r"u=u_m-K(\hat x-x_m),\quad u_m=(m\ddot y_m+\beta\dot y_m+ky_m)/F"),
        Equation("filter", r"\hat x=\bar x+L(y-C\bar x),\quad \bar x=\Phi\hat x+\Gamma u"),
        Equation("cost", r"J=\mathsf E\,\bigl[(y-y_m)^2+\rho\,(u-u_m)^2\bigr]"),
        Equation("regulator", r"P=\Phi^TP\Phi-\Phi^TP\Gamma(\rho+\Gamma^TP\Gamma)^{-1}\Gamma^TP\Phi+C^TC"),
    )
    structure = (
        Stage("Kalman filter", "applied measured", "estimate velocity", ("filter",)),
        Stage("Law", "reference model model_velocity estimate velocity", "voltage", ("law", "cost", "regulator")),
    )
    weaknesses = ("It has no integral action: under a device that differs from the nominal device an error stays.",)

    class Params(LqgParams, KnownParams):
        """The assumed device, the cost of the voltage, and the assumed noise."""

    class Packed(LqgLaw):
        """The law."""

    class State(Record):
        """Estimated displacement and velocity."""

        estimate: Motion

    class Ports(FollowingPorts):
        """Ports of a controller, the velocity of the model, and the estimates."""

        estimate: float = tap("um", "estimated displacement")
        velocity: float = tap("um/ms", "estimated velocity")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices without mass, and models that do not come to rest."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the law of the assumed device."""
        p = cls.Packed.blank()
        fill_law(p, known(params, context), params, context)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Predict by the voltage applied, correct by the measurement, regulate about the motion of the model."""
        x.voltage = regulated(p, s.estimate, x)
        x.estimate = s.estimate.x
        x.velocity = s.estimate.v


def gains(phi: FloatArray, seen: FloatArray, noise: FloatArray, measured: float, *, shift: bool = False) -> FloatArray:
    r"""Return the gain of a Kalman filter in the limit, :math:`PH^T(HPH^T+R)^{-1}`; shifted, the gain of its predictor.

    The predictor of the transposed system is the regulator, :math:`K=(\rho+\Gamma^TP\Gamma)^{-1}\Gamma^TP\Phi`.

    Parameters
    ----------
    phi, noise : ndarray, shape (2, 2)
        Transition over a sample, and the covariance that noise adds in it.
    seen : ndarray, shape (1, 2)
        The row H of the measurement.
    measured : float
        Variance R of the measurement.
    """
    # a little noise on both states, because a device that cannot be moved has no limit without it
    try:
        prior = riccati(phi, seen, noise + np.eye(2) * 1e-18, np.array([[measured]]))
    except InputError:  # the numbers of this device are too far apart: no feedback
        return np.zeros(2)
    turned = product(phi, prior, seen.T) if shift else product(prior, seen.T)
    found: FloatArray = solved(product(seen, prior, seen.T) + measured, turned.T)[0]
    return found
