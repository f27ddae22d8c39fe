"""The state of a mixture of models: mean, covariance, and its errors against the true motion."""

from __future__ import annotations

import math

from core.kernel import kernel
from core.loop.weighted_parameters import ParameterErrors, ParameterPorts
from core.ports import reads, tap
from core.record import Vector


class MotionErrors(ParameterErrors):
    """Also the sums of squared errors of displacement and velocity."""

    displacement_square: float
    velocity_square: float


class MixturePorts(ParameterPorts):
    """Also the states of the models and the true motion; the weighted state and its covariance."""

    state_displacement: Vector = reads("^state_displacement", "um", "displacements under the hypotheses")
    state_velocity: Vector = reads("^state_velocity", "um/ms", "velocities under the hypotheses")
    variance_displacement: Vector = reads("^variance_displacement", "um^2", "variances of these displacements")
    model_covariance: Vector = reads("^covariance", "um^2/ms", "covariances of displacement and velocity")
    variance_velocity: Vector = reads("^variance_velocity", "um^2/ms^2", "variances of these velocities")
    true_displacement: float = reads("plant.displacement", "um", "true displacement")
    true_velocity: float = reads("plant.velocity", "um/ms", "true velocity")
    displacement: float = tap("um", "displacement, weighted by the probabilities")
    velocity: float = tap("um/ms", "velocity, weighted by the probabilities")
    displacement_std: float = tap("um", "standard deviation of this displacement")
    velocity_std: float = tap("um/ms", "standard deviation of this velocity")
    covariance: float = tap("um^2/ms", "covariance of both")


@kernel
def mix(x: MixturePorts, n: int) -> None:
    r"""Put out mean and covariance of a mixture.

    .. math:: \hat x=\sum_kp_k\hat x_k,\qquad P=\sum_kp_k\left[P_k+(\hat x_k-\hat x)(\hat x_k-\hat x)^T\right]
    """
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


@kernel
def compare_motion(s: MotionErrors, x: MixturePorts) -> float:
    """Add the squared errors of displacement and velocity; return the former."""
    e1 = x.displacement - x.true_displacement
    e2 = x.velocity - x.true_velocity
    s.displacement_square += e1 * e1
    s.velocity_square += e2 * e2
    return float(e1 * e1)
