"""Ideal displacement sensor with white noise and a converter."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, parameter
from core.converter import step_of
from core.elementary import floor
from core.noise import normal
from core.ports import BlockPorts, output, reads
from core.record import Record, stream


class Ideal(Block):
    r"""Displacement plus white noise, rounded by the converter, :math:`z_i=q\,[(x_i+v_i)/q]`."""

    title = "Ideal sensor"
    equations = (Equation("measurement", r"z_i=x(t_i)+v_i,\quad v_i\sim N(0,\sigma^2)", "5.2.1"),)

    class Params(BlockParams):
        """Parameters of the ideal sensor."""

        noise_um: float = parameter(0.01, "standard deviation of the white noise", "um", ge=0, le=100)
        quantum_um: float = parameter(0.0, "step of the converter, 0 for none", "um", ge=0, le=100)
        bits: int = parameter(0, "bits of the converter in place of its step: range over 2 to the bits", ge=0, le=48)
        range_um: float = parameter(40.0, "range of the converter to either side", "um", gt=0)

    class Packed(Record):
        """The noise and its stream, the converter."""

        noise_um: float
        key: float = stream("sensor")
        quantum_um: float
        range_um: float

    class Ports(BlockPorts):
        """True and measured displacement."""

        true: float = reads("plant.displacement", "um", "true displacement")
        displacement: float = output("um", "measured displacement")

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        r"""Return the noise of a sample, :math:`\sqrt{\sigma^2+q^2/12}`: rounding spreads evenly over a step."""
        step = step_of(params.quantum_um, params.bits, params.range_um)
        return math.sqrt(params.noise_um * params.noise_um + step * step / 12.0)

    @classmethod
    def ambiguity_um(cls, params: Any, context: Context) -> float:
        """Return 0: the sensor distinguishes all displacements."""
        return 0.0

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        step = step_of(params.quantum_um, params.bits, params.range_um)
        p.quantum_um = step
        if step > 0.0:  # the last step within the range
            last = step * floor(params.range_um / step + 1e-9)
            p.range_um = min(params.range_um, last)
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Read the displacement."""
        z = x.true
        if p.noise_um > 0.0:
            z += p.noise_um * normal(p.key, x.tick)
        if p.quantum_um > 0.0:
            z = p.quantum_um * floor(z / p.quantum_um + 0.5)
            z = min(max(z, -p.range_um), p.range_um)
        x.displacement = z
