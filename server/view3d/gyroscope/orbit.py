"""The visible part of an orbit: the sample of a strobe, and the factors that make it visible."""

from __future__ import annotations

import numpy as np

from core.format import format_short
from server.view3d.motion import exaggeration
from server.view3d.solids import FloatArray

WANTED_UM = 32.0
"""Amplitude that is well seen at the size of the schematic device, and that it has room for."""
FACTORS = (*(step * 10.0**power for power in range(6) for step in (1.0, 2.0, 5.0)), 1e6)
ALIKE = 0.2
"""From this share on of the larger amplitude, the smaller is magnified as much: the orbit keeps its shape."""


def met(motion: FloatArray, phase: float) -> int | None:
    """Return the sample of the last whole period at a phase, or None where there is no whole period.

    Parameters
    ----------
    motion : ndarray, shape (ticks,)
        A few recent periods.
    phase : float
        From 0 to 1 between two rises through 0; in between they are straight.
    """
    rises = np.flatnonzero((motion[:-1] < 0.0) & (motion[1:] >= 0.0))[-2:]
    if len(rises) < 2:
        return None
    first, last = rises + motion[rises] / (motion[rises] - motion[rises + 1])
    return round(float(first + phase * (last - first)))


def magnified(largest: tuple[float, float], now: tuple[float, float]) -> tuple[float, float]:
    """Return the factors on x and y.

    Parameters
    ----------
    largest : tuple of float
        Largest recent displacements along x and y, um.
    now : tuple of float
        The factors until now; they stay while they do.
    """
    if min(largest) > ALIKE * max(largest):
        both = exaggeration(max(largest), now[0], WANTED_UM, FACTORS)
        return both, both
    x, y = (exaggeration(size, factor, WANTED_UM, FACTORS) for size, factor in zip(largest, now, strict=True))
    return x, y


def full_scale(largest: float, now: float) -> float:
    """Return the round rate of half the ring; it stays while the rate is well visible on it."""
    if largest == 0.0 or 0.15 * now <= largest <= 0.85 * now:
        return now
    power = 10.0 ** np.floor(np.log10(largest))
    return float(next(step * power for step in (1.0, 2.0, 5.0, 10.0, 20.0) if 0.8 * step * power >= largest))


def caption(factors: tuple[float, float], half_ring: float, is_strobed: bool) -> str:
    """Return in words how the picture differs from the true motion.

    Parameters
    ----------
    factors : tuple of float
        Exaggeration of the motion along x and y.
    half_ring : float
        The rate of half the ring, deg/s.
    is_strobed : bool
        Whether the motion shown is slower than the true one.
    """
    x, y = (format_short(factor, "", 3) for factor in factors)
    parts = ["schematic, not to scale", f"motion x × {x}, y × {y}", f"half ring {format_short(half_ring, 'deg/s', 3)}"]
    if is_strobed:
        parts.append("strobe")
    return ", ".join(parts)
