"""What every sensor shares: the noise others should assume of it, and what a calibration would tell."""

from __future__ import annotations

from typing import Any, TypeVar

from core.block import Block, BlockParams, Context

P = TypeVar("P", bound=BlockParams)


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
