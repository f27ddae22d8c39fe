"""Extended Kalman filter of motion, spring and damper."""

from __future__ import annotations

from typing import Any

from core.block import Context, Stage
from core.identify.estimator import Estimator
from core.joint_filter import (
    EQUATIONS,
    FILTER,
    Joint,
    JointFilterParams,
    JointPorts,
    PackedJointFilter,
    fill_joint,
    fill_start,
    follow,
)
from core.record import Record


class EkfIdentifier(Estimator):
    r"""Extended Kalman filter of :math:`(x,\dot x,\kappa,\delta)` (Jazwinski 1970, 8.3; Ljung 1979).

    .. math:: m\ddot x+\delta\beta\dot x+\kappa kx=Fu,\quad\dot\kappa=w_\kappa,\;\dot\delta=w_\delta,\quad y=x+n

    Spring and damper are part of the state and wander at random: a filter that assumes a larger walk follows a fault
    sooner and is noisier. The covariance shows how well this input determines both. The mass is taken as nominal.
    """

    title = "Extended Kalman filter (EKF)"
    every_tick = True
    equations = EQUATIONS
    structure = (FILTER, Stage("Estimate", "stiffness damping", "estimate"))
    weaknesses = (
        "It takes the mass for nominal: under a tone a mass that has changed is a spring that has changed, by "
        "(omega/omega_0)^2 of the mass and in the other direction.",
    )

    class Params(JointFilterParams):
        """Assumed noise and the uncertainty at the start."""

    class Packed(PackedJointFilter):
        """The device and the assumptions."""

    class State(Joint):
        """The filter."""

    class Ports(Estimator.Ports, JointPorts):
        """The estimate, and the filter behind it."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> Record:
        """Pack the filter."""
        p = cls.Packed.zeros()
        fill_joint(p, params, context)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> Record:
        """Start with the nominal device, which does not move."""
        s = cls.State.zeros()
        fill_start(s, params, context)
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Predict, correct, and put out the factors."""
        if follow(p, s, x):
            x.estimate[0] = 1.0
            x.estimate[1] = s.stiffness
            x.estimate[2] = s.damping
