"""Two beams through the grating, a quarter of a pitch apart: two intensities in quadrature."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, parameter
from core.noise import normal
from core.ports import BlockPorts, output, reads
from core.record import Record, stream
from core.sense.grating import BeamParams, Grating, level
from core.sense.sensor import Sensor


class DualBeam(Sensor):
    r"""Intensities of two beams 1 um apart (6.3), :math:`I_a(x)` and :math:`I_b(x)=I_a(x-s)`.

    At :math:`s=\Lambda/4` one is the cosine and the other the sine of the same phase. The pair therefore gives
    displacement and direction, which a single beam cannot. The text proposes two beams without their distance; the
    panel "1-micron displacement" of figure 6.3.1.1 is read as the spacing.
    """

    title = "Two beams"
    equations = (Equation("pair", r"I_a=I(x)+v_a,\quad I_b=I(x-s)+v_b,\quad s=\Lambda/4", "6.3 in words"),)

    class Params(BeamParams):
        """Grating, beams and detectors."""

        spacing_um: float = parameter(1.0, "distance between the beams", "um", ge=-100, le=100, equation="6.3")

    class Packed(Grating):
        """The light over the grating, the noise of both detectors and their streams, the distance between the beams."""

        noise: float
        first_key: float = stream("sensor.dual_beam.first")
        second_key: float = stream("sensor.dual_beam.second")
        spacing_um: float

    class Ports(BlockPorts):
        """Reads the displacement; writes both beams."""

        true: float = reads("plant.displacement", "um", "true displacement")
        first: float = output("1", "light of the first beam, full light being 1")
        second: float = output("1", "light of the second beam, full light being 1")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p: DualBeam.Packed = params.packed(cls.Packed, context)
        p.noise = params.noise
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Detect both beams."""
        x.first = level(p, x.true) + p.noise * normal(p.first_key, x.tick)
        x.second = level(p, x.true - p.spacing_um) + p.noise * normal(p.second_key, x.tick)
