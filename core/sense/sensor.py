"""What every sensor shares: the noise others should assume of it, and what a calibration would tell."""

from __future__ import annotations

from typing import Any, TypeVar

from core.block import Block, BlockParams, Context, Port, kernel, parameter

ENGAGED_PORT = Port("engaged", "1", "1 while the sensor in use needs this one, or it always runs", source="@engaged")
LAST_PORT = Port("last", "um", "what was measured last: where to take over", source="sensor.displacement")

P = TypeVar("P", bound=BlockParams)


class SensorParams(BlockParams):
    """What every sensor that may rest has."""

    always: bool = parameter(False, "run even while the sensor in use does not need it; it puts out 0 while it rests")


@kernel
def rest(w: Any, io: Any, first: int, last: int) -> None:
    """Put out zeros."""
    for port in range(first, last + 1):
        w[io[port]] = 0.0


class Sensor(Block):
    """A sensor; ``noise_um`` is the white displacement noise that filters fed by it should assume."""

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        """Return the standard deviation of the equivalent white noise of one sample."""
        return float(getattr(params, "noise_um", 0.0))


def calibrated(context: Context, name: str, kind: type[P]) -> P:
    """Return the parameters of another sensor, as a calibration of it would tell them; its defaults if unknown."""
    params = context.sensors.get(name)
    return params if isinstance(params, kind) else kind()
