"""Measurement: the sensor whose reading controllers and diagnosers get, with the faults of the measurement."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context
from core.elementary import floor
from core.ports import BlockPorts, output, reads, tap
from core.record import Choice, Record, Records
from core.sense.past import KEPT, Entry, note
from core.voltage import AppliedPorts


class ChosenPorts(BlockPorts):
    """The sensor in use, and the faults of the measurement."""

    chosen: float = reads("@measuring", "um", "displacement of the sensor in use")
    offset: float = reads("effects.sensor_offset", "um", "added to the measurement")
    quantum: float = reads("effects.sensor_quantum", "um", "rounding step of the measurement")
    held: float = reads("effects.sensor_held", "1", "not zero while the sample is lost")
    missing: float = reads("plant.missing?", "1", "not zero where a record lacks the sample")


class Measurement(Block):
    """Passes on the displacement of the sensor in use; all sensors run, so a change is one index.

    Faults of the measurement act in the order of the chain: additions before the converter, the converter, lost samples
    after it. The last samples are kept for a sensor that takes over in motion.
    """

    title = "Measurement"

    class Params(BlockParams):
        """Nothing to choose but the sensor."""

    class Packed(Record):
        """Variance of a sample, and how often there is one."""

        variance: float
        every: Choice

    class Ports(ChosenPorts, AppliedPorts):
        """The sensor in use and the voltage in, the measurement and the past out."""

        displacement: float = output("um", "measured displacement")
        past: Records[Entry] = tap(
            "mixed",
            "measurements of the last samples, with voltage and variance",
            labels=tuple(str(i) for i in range(KEPT * Entry.layout.size)),
            hidden=True,
        )

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the variance of a sample, not 0 so that it counts as measured, and how often there is one."""
        noise = max(context.sensor_noise_um, 1e-6)
        p = cls.Packed.blank()
        p.variance, p.every = noise * noise, context.sensor_every
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Pass on the displacement of the sensor in use, unless the sample was lost."""
        if x.held != 0.0 or x.missing != 0.0:
            note(x.past, x, 0.0, 0.0)
        else:
            z = x.chosen
            if x.offset != 0.0:
                z += x.offset
            if x.quantum != 0.0:
                z = x.quantum * floor(z / x.quantum + 0.5)
            x.displacement = z
            # a division costs more than the rest of this step, and most sensors run at every tick
            fresh = (p.every == 1.0 or int(x.tick) % int(p.every) == 0) and math.isfinite(z)
            variance = p.variance + x.quantum * x.quantum / 12.0
            note(x.past, x, z, variance if fresh else 0.0)
