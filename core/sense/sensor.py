"""Base of the sensors: the noise that filters should assume, the ambiguity, and the calibration."""

from __future__ import annotations

import math
from typing import Any, TypeVar

from core.block import Block, BlockParams, Context, parameter
from core.elementary import floor
from core.kernel import kernel
from core.ports import output, reads, tap

LAST_PORT = reads("sensor.displacement", "um", "last measurement: where to take over")

TRUE_PORT = reads("@true.displacement", "um", "true displacement, for the error only")
RECOVERED_PORT = output("um", "recovered displacement")
ERROR_PORT = tap("um", "recovered minus true displacement")
SLIPS_PORT = tap("1", "whole pitches it is off by")

P = TypeVar("P", bound=BlockParams)


class SensorParams(BlockParams):
    """The parameter of every sensor that may be idle."""

    always: bool = parameter(False, "run even while the sensor in use does not need it; it puts out 0 while it rests")


@kernel
def begin_at(last: float) -> float:
    """Return the displacement to begin with: the last measured one, or 0 if that is not a finite number."""
    return last if math.isfinite(last) else 0.0


@kernel
def slips(error: float, pitch: float) -> float:
    """Return the error of a recovered displacement in whole pitches."""
    return float(floor(error / pitch + 0.5)) if math.isfinite(error) else 0.0


class Sensor(Block):
    """A sensor, with the noise that its filters should assume and the distance of displacements that look alike."""

    @classmethod
    def runs_always(cls, params: Any) -> bool:
        """Say whether it runs even while nothing reads it."""
        return bool(params.always)

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        """Return the standard deviation of the equivalent white noise of one sample."""
        return 0.0

    @classmethod
    def ambiguity_um(cls, params: Any, context: Context) -> float:
        """Return the distance of displacements that look alike to it; 0 for an absolute sensor."""
        return 0.0


def calibrated(context: Context, name: str, kind: type[P]) -> P:
    """Return the parameters that a calibration of another sensor would give; its defaults if unknown."""
    params = context.sensors.get(name)
    return params if isinstance(params, kind) else kind()
