"""Light through the grating in the shuttle: an intensity, from which others recover the displacement."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, Port
from core.noise import key, normal
from core.sense.grating import BeamParams, level
from core.sense.sensor import Sensor

NOISE, KEY, GRATING = range(3)
TRUE, INTENSITY = range(2)


def through_wafer_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Let the light through and detect it."""
    w[io[INTENSITY]] = level(p, GRATING, w[io[TRUE]]) + p[NOISE] * normal(p[KEY], w[TICK])


class ThroughWafer(Sensor):
    r"""Intensity of a focused beam through the moving grating (2.2.2).

    .. math:: I(x)=D+(1-D)T_b+\sum_m(1-T_b)\frac{2}{\pi m}\sin(\pi mD)\,e^{-(\pi mw/\Lambda)^2/2}
        \cos\frac{2\pi m(x-x_0)}{\Lambda}

    It says where in a period the shuttle is, up to a reflection: the direction of the motion is not in it. At a
    spot of 4.6 um, the unfocused mode of a fibre, the visibility is 0.0006: the two bulk lenses are essential.
    """

    title = "Through-wafer intensity"
    inputs = (Port("true", "um", "true displacement", source="plant.displacement"),)
    outputs = (Port("intensity", "1", "detected light, full light being 1"),)
    equations = (
        Equation(
            "intensity",
            r"I=D+(1-D)T_b+\sum_m(1-T_b)\tfrac{2}{\pi m}\sin(\pi mD)\,e^{-(\pi mw/\Lambda)^2/2}"
            r"\cos\tfrac{2\pi m(x-x_0)}{\Lambda}+v,\quad \sigma_v=\tfrac{c_1}{\sqrt2}10^{-SNR/20}",
            "2.2.2 in words; openings of 2 um",
        ),
    )

    class Params(BeamParams):
        """Grating, beam and detector."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        return np.array([params.noise, key(context.seed, "sensor.through_wafer"), *params.packed(context)])

    step = through_wafer_step
