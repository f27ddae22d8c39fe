"""Measurement of an axis: the input of controllers and diagnosers, with the faults of the measurement."""

from __future__ import annotations

from typing import Any

from core.block import Block, BlockParams, Context
from core.elementary import floor
from core.ports import BlockPorts, output, reads
from core.record import Record


class AxisMeasurement(Block):
    """Passes on the reading of one axis of the sensor in use; a fault of the read-out acts on all axes alike, or on y.

    Faults come in the order of the chain: additions before the converter, the converter, lost samples after it.
    """

    title = "Measurement of an axis"
    per_axis = True

    class Params(BlockParams):
        """Nothing to choose but the sensor."""

    class Packed(Record):
        """Whether the axis is y, the sensing axis."""

        senses: float

    class Ports(BlockPorts):
        """The sensor in use, the faults of the measurement, and the measurement."""

        chosen: float = reads("@measuring", "um", "displacement of the sensor in use")
        chosen_velocity: float = reads("@measuring_velocity", "um/ms", "velocity of the sensor in use")
        offset: float = reads("effects.sensor_offset", "um", "added to the measurement")
        own_offset: float = reads("effects.second_sensor_offset", "um", "added to the measurement along y")
        quantum: float = reads("effects.sensor_quantum", "um", "rounding step of the measurement")
        held: float = reads("effects.sensor_held", "1", "not zero while the sample is lost")
        displacement: float = output("um", "measured displacement along the axis")
        velocity: float = output("um/ms", "measured velocity along the axis")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the axis."""
        p = cls.Packed.blank()
        p.senses = float(context.axis == "y")
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Pass on displacement and velocity, unless the sample was lost."""
        if x.held == 0.0:
            z = x.chosen
            if x.offset != 0.0:
                z += x.offset
            if p.senses != 0.0 and x.own_offset != 0.0:
                z += x.own_offset
            if x.quantum != 0.0:
                z = x.quantum * floor(z / x.quantum + 0.5)
            x.displacement = z
            x.velocity = x.chosen_velocity
