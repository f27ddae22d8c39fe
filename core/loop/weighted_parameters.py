"""The parameters of the device as a bank weighs them."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, Context, Equation
from core.diagnose.hypothesis import BankParams
from core.diagnose.lanes import LANE
from core.kernel import kernel
from core.ports import BlockPorts, reads, tap
from core.record import Choice, Record, Vector, vector

PARTS = ("mass", "stiffness", "damping")
"""Parameters whose estimates are compared with the truth."""


class ParameterPorts(BlockPorts):
    """Probabilities and the true factors; the weighted factors."""

    probability: Vector = reads("^probability", "1", "probabilities of the bank")
    mass_scale: float = reads("effects.mass_scale", "1", "true mass over nominal")
    stiffness_scale: float = reads("effects.stiffness_scale", "1", "true stiffness over nominal")
    damping_scale: float = reads("effects.damping_scale", "1", "true damping over nominal")
    mass: float = tap("1", "mass over nominal, weighted by the probabilities")
    stiffness: float = tap("1", "stiffness over nominal, weighted by the probabilities")
    damping: float = tap("1", "damping over nominal, weighted by the probabilities")
    gain: float = tap("1", "drive gain over nominal, weighted by the probabilities")


class Models(Record):
    """The number of hypotheses, and their factors on the nominal device."""

    count: Choice
    mass: Vector = vector(LANE)
    stiffness: Vector = vector(LANE)
    damping: Vector = vector(LANE)
    gain: Vector = vector(LANE)


class ParameterErrors(Record):
    """Samples so far, and sums of the squared errors of mass, stiffness and damping over them."""

    samples: float
    mass: float
    stiffness: float
    damping: float


@kernel
def weigh_parameters(p: Models, s: ParameterErrors, x: ParameterPorts, n: int) -> None:
    """Put out the weighted factors, and add their squared errors."""
    mass = 0.0
    stiffness = 0.0
    damping = 0.0
    gain = 0.0
    for i in range(n):
        weight = x.probability[i]
        mass += weight * p.mass[i]
        stiffness += weight * p.stiffness[i]
        damping += weight * p.damping[i]
        gain += weight * p.gain[i]
    x.mass = mass
    x.stiffness = stiffness
    x.damping = damping
    x.gain = gain
    compare_parameters(s, x)


@kernel
def compare_parameters(s: ParameterErrors, x: ParameterPorts) -> None:
    """Add the squared errors of the weighted factors; factors that are no numbers do not count."""
    mass = x.mass
    stiffness = x.stiffness
    damping = x.damping
    if math.isfinite(mass + stiffness + damping):
        s.samples += 1.0
        s.mass += (mass - x.mass_scale) * (mass - x.mass_scale)
        s.stiffness += (stiffness - x.stiffness_scale) * (stiffness - x.stiffness_scale)
        s.damping += (damping - x.damping_scale) * (damping - x.damping_scale)


class WeightedParameters(Block):
    r"""Weighs the parameters of the hypotheses by their probabilities, :math:`\hat\theta=\sum_kp_k\theta_k`.

    Where two hypotheses share the probability, the device is taken to be between them.
    """

    title = "Weighted parameters"
    equations = (Equation("parameters", r"\hat\theta=\sum_kp_k\theta_k", "5.2.3.2"),)
    Params = BankParams
    Packed = Models
    State = ParameterErrors
    Ports = ParameterPorts

    @classmethod
    def pack(cls, params: Any, context: Context) -> Models:
        """Pack the factors of the hypotheses."""
        return with_factors(cls.Packed.blank(), params)

    @staticmethod
    def step(p: Models, s: ParameterErrors, x: ParameterPorts) -> None:
        """Weigh the parameters."""
        weigh_parameters(p, s, x, int(p.count))


def with_factors(p: Models, params: Any) -> Models:
    """Pack the number of hypotheses and their factors."""
    n = p.count = len(params.hypotheses)
    for part in (*PARTS, "gain"):
        getattr(p, part)[:n] = [getattr(item, part) for item in params.hypotheses]
    return p
