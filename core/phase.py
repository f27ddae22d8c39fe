"""Phase: counted in turns, so that a sine is as exact after hours as at the start."""

from __future__ import annotations

import math

from core.elementary import floor, sin
from core.kernel import kernel


@kernel
def sine_of(turns: float) -> float:
    """Return the sine of a phase in turns; whole turns are taken off first."""
    return sin(2.0 * math.pi * (turns - floor(turns)))
