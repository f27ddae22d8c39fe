"""Colours of the parts: mixed, and as a batch of viser takes them."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

Color = tuple[int, int, int]

SILICON, MOVING, FIXED, GROUND = (150, 158, 170), (86, 180, 233), (110, 118, 130), (52, 58, 68)
REFERENCE, ESTIMATE, LIGHT = (223, 228, 234), (31, 184, 143), (240, 110, 190)
ATTENTION = (232, 64, 52)


def blend(first: Color, second: Color, share: float) -> Color:
    """Mix two colours."""
    red, green, blue = (round(a + (b - a) * share) for a, b in zip(first, second, strict=True))
    return red, green, blue


@cache
def in_batch(color: Color) -> NDArray[np.uint8]:
    """Return a colour for a batch: viser takes colours of batches as linear, all others as sRGB."""
    share = np.array(color) / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return np.asarray(np.round(255.0 * linear), dtype=np.uint8)
