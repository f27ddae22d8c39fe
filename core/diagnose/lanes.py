"""Models side by side: every number of a bank's models lies in a lane, so that a processor works on many at once.

A lane is as long as the longest list of hypotheses. That its length is known when a step is compiled, and that the
arrays of a step lie apart, is what lets the compiler put neighbours into one vector register. Element by element the
arithmetic is the same, so are the bits.
"""

from __future__ import annotations

import numpy as np

from core.block import FloatArray

LANE = 16
"""Length of a lane: the most hypotheses there may be."""


def lanes(rows: int, models: int) -> FloatArray:
    """Return empty lanes; what works on its models one by one may have more than others have room for."""
    return np.zeros((rows, max(models, LANE)))
