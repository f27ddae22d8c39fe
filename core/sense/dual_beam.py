"""Two beams through the grating, a quarter of a pitch apart: two intensities in quadrature."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, Port, parameter
from core.noise import key, normal
from core.sense.grating import BeamParams, level
from core.sense.sensor import Sensor

NOISE, FIRST_KEY, SECOND_KEY, SPACING, GRATING = range(5)
TRUE, FIRST, SECOND = range(3)


def dual_beam_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Detect both beams."""
    x = w[io[TRUE]]
    w[io[FIRST]] = level(p, GRATING, x) + p[NOISE] * normal(p[FIRST_KEY], w[TICK])
    w[io[SECOND]] = level(p, GRATING, x - p[SPACING]) + p[NOISE] * normal(p[SECOND_KEY], w[TICK])


class DualBeam(Sensor):
    r"""Intensities of two beams 1 um apart (6.3), :math:`I_a(x)` and :math:`I_b(x)=I_a(x-s)`.

    At :math:`s=\Lambda/4` one is the cosine and the other the sine of the same phase, which a single beam cannot
    tell: displacement and direction are both in the pair. The text proposes two beams without saying how far apart;
    the panel "1-micron displacement" of figure 6.3.1.1 is read as the spacing.
    """

    title = "Two beams"
    inputs = (Port("true", "um", "true displacement", source="plant.displacement"),)
    outputs = (
        Port("first", "1", "light of the first beam, full light being 1"),
        Port("second", "1", "light of the second beam, full light being 1"),
    )
    equations = (Equation("pair", r"I_a=I(x)+v_a,\quad I_b=I(x-s)+v_b,\quad s=\Lambda/4", "6.3 in words"),)

    class Params(BeamParams):
        """Grating, beams and detectors."""

        spacing_um: float = parameter(1.0, "distance between the beams", "um", ge=-100, le=100, equation="6.3")

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        keys = [key(context.seed, f"sensor.dual_beam.{name}") for name in ("first", "second")]
        return np.array([params.noise, *keys, params.spacing_um, *params.packed(context)])

    step = dual_beam_step
