"""Sources of the velocity that a controller feeds back."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Context, parameter
from core.control.observer import Observed, StateObserver, observe, observer_of
from core.kernel import kernel
from core.record import Record

SOURCES = ("true", "difference", "observer")
Source = Literal["true", "difference", "observer"]
TRUE, DIFFERENCE = SOURCES.index("true"), SOURCES.index("difference")
OBSERVER_POLE = 6.0
"""Triple pole of the observer, as a multiple of the rate of the device."""


class PackedVelocity(Record):
    """The source, sample interval, rate of the device, and the observer."""

    source: float
    dt_ms: float
    rate: float
    observer: StateObserver


class VelocityState(Record):
    """Last measurement, whether there is one, and the observer."""

    last: float
    known: float
    observed: Observed


def velocity_source() -> Any:
    """Declare the parameter that chooses the source."""
    return parameter("true", "velocity from the plant itself, from the difference of two samples, or from an observer")


def velocity_of(source: Source, context: Context) -> PackedVelocity:
    """Pack the source."""
    device = context.device
    p = PackedVelocity.zeros()
    p.source, p.dt_ms, p.rate = SOURCES.index(source), context.dt_ms, device.natural_frequency
    if device.mass == 0.0:
        p.source = TRUE  # a law for a plant without mass feeds back no velocity
    else:
        p.observer = observer_of(device, context, OBSERVER_POLE * p.rate)
    return p


@kernel
def velocity(p: PackedVelocity, s: VelocityState, true: float, y: float, u: float, middle: float, end: float) -> float:
    """Return the velocity now, um/ms; ``u`` was applied at the start of the interval that ends now.

    In the middle of the interval the voltage was larger by ``middle``, and at its end by ``end``.
    """
    last = s.last
    known = s.known != 0.0
    s.last = y
    s.known = 1.0
    if p.source == TRUE:
        return true
    if p.source == DIFFERENCE:
        return (y - last) / p.dt_ms if known else 0.0
    observe(p.observer, s.observed, y if known else math.nan, u, middle, end)
    return s.observed.motion.v
