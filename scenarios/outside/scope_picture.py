"""Pictures of a bench that an agent drives, drawn in numpy: model and displacement above, the voltage below."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from core.block import FloatArray

Picture = NDArray[np.uint8]
WIDTH, HEIGHT, MARGIN = 480, 320, 8
SHARE = 0.7
"""Of the height, for the displacements."""
PAPER, LINES = (255, 255, 255), (208, 208, 208)
MODEL, DISPLACEMENT, VOLTAGE = (150, 150, 150), (0, 90, 181), (180, 80, 0)


class ScopePicture:
    """The last samples of a board, one for each column of the picture.

    Parameters
    ----------
    scale_um, limit_v : float
        The displacement and the voltage at the edges of their parts.
    """

    def __init__(self, scale_um: float, limit_v: float) -> None:
        self._scales = scale_um, scale_um, limit_v
        self._rows: deque[FloatArray] = deque(maxlen=WIDTH)

    def clear(self) -> None:
        """Forget all samples: another episode begins."""
        self._rows.clear()

    def add(self, rows: FloatArray) -> None:
        """Take samples, shape (ticks, 3): model displacement, true displacement, applied voltage."""
        self._rows.extend(rows)

    def draw(self) -> Picture:
        """Return the picture, shape (height, width, 3)."""
        picture = np.full((HEIGHT, WIDTH, 3), PAPER, dtype=np.uint8)
        split = round(SHARE * HEIGHT)
        parts = (MARGIN, split - MARGIN), (split + MARGIN, HEIGHT - MARGIN)
        for top, bottom in parts:
            picture[[top, (top + bottom) // 2, bottom]] = LINES
        if self._rows:
            rows = np.nan_to_num(np.array(self._rows)) / self._scales
            for signal, colour, part in ((2, VOLTAGE, 1), (0, MODEL, 0), (1, DISPLACEMENT, 0)):
                _draw(picture, rows[:, signal], colour, *parts[part])
        return picture


def _draw(picture: Picture, values: FloatArray, colour: tuple[int, int, int], top: int, bottom: int) -> None:
    """Draw a line through values from -1 (bottom) to 1 (top), each joined to the one before."""
    middle, half = (top + bottom) / 2, (bottom - top) / 2
    places = np.rint(middle - half * np.clip(values, -1.0, 1.0)).astype(np.int64)
    before = np.concatenate([places[:1], places[:-1]])
    for column, (first, last) in enumerate(zip(np.minimum(places, before), np.maximum(places, before), strict=True)):
        picture[first : last + 1, column] = colour
