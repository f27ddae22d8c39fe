"""Ideal displacement sensor with white noise and a converter."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import TICK, Block, BlockParams, Context, Equation, FloatArray, Port, parameter
from core.noise import key, normal

NOISE, KEY, QUANTUM, RANGE = range(4)


def ideal_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Read the displacement."""
    z = w[io[0]]
    if p[NOISE] > 0.0:
        z += p[NOISE] * normal(p[KEY], w[TICK])
    if p[QUANTUM] > 0.0:
        z = p[QUANTUM] * math.floor(z / p[QUANTUM] + 0.5)
        z = min(max(z, -p[RANGE]), p[RANGE])
    w[io[1]] = z


class Ideal(Block):
    r"""Displacement plus white noise, rounded by the converter, :math:`z_i=q\,[(x_i+v_i)/q]`."""

    title = "Ideal sensor"
    inputs = (Port("displacement", "um", "true displacement", source="plant.displacement"),)
    outputs = (Port("displacement", "um", "measured displacement"),)
    equations = (Equation("measurement", r"z_i=x(t_i)+v_i,\quad v_i\sim N(0,\sigma^2)", "5.2.1"),)

    class Params(BlockParams):
        """Parameters of the ideal sensor."""

        noise_um: float = parameter(0.01, "standard deviation of the white noise", "um", ge=0, le=100)
        quantum_um: float = parameter(0.0, "step of the converter, 0 for none", "um", ge=0, le=100)
        range_um: float = parameter(40.0, "range of the converter to either side", "um", gt=0)

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        r"""Return the noise of a sample, :math:`\sqrt{\sigma^2+q^2/12}`: rounding spreads evenly over a step."""
        return math.hypot(params.noise_um, params.quantum_um / math.sqrt(12.0))

    @classmethod
    def ambiguity_um(cls, params: Any, context: Context) -> float:
        """Return that it tells all displacements apart."""
        return 0.0

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        return np.array([params.noise_um, key(context.seed, "sensor"), params.quantum_um, params.range_um])

    step = ideal_step
