"""Light through the grating in the shuttle: an intensity, from which other blocks recover the displacement."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation
from core.noise import normal
from core.ports import BlockPorts, output, reads
from core.record import Record, stream
from core.sense.grating import BeamParams, Grating, level
from core.sense.sensor import Sensor


class ThroughWafer(Sensor):
    r"""Intensity of a focused beam through the moving grating (2.2.2).

    .. math:: I(x)=D+(1-D)T_b+\sum_m(1-T_b)\frac{2}{\pi m}\sin(\pi mD)\,e^{-(\pi mw/\Lambda)^2/2}
        \cos\frac{2\pi m(x-x_0)}{\Lambda}

    It shows the position of the shuttle within a period, up to a reflection, and not the direction of the motion. At a
    spot of 4.6 um, the unfocused mode of a fibre, the visibility is 0.0006: the two bulk lenses are essential.
    """

    title = "Through-wafer intensity"
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

    class Packed(Grating):
        """The light over the grating, the noise of the detector and its stream."""

        noise: float
        key: float = stream("sensor.through_wafer")

    class Ports(BlockPorts):
        """Reads the displacement; writes the light."""

        true: float = reads("plant.displacement", "um", "true displacement")
        intensity: float = output("1", "detected light, full light being 1")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p: ThroughWafer.Packed = params.packed(cls.Packed, context)
        p.noise = params.noise
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Let the light through and detect it."""
        x.intensity = level(p, x.true) + p.noise * normal(p.key, x.tick)
