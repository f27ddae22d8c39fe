"""Arrays with guards on both sides: numbers that no computation gives, and that must stay."""

from __future__ import annotations

from typing import Any

import numpy as np

GUARD = np.uint64(0x7FF4C0DE0BADBEEF)
"""The bits of a guard: as a number it is no number, with a mark that no arithmetic gives."""
ROOM = 64
"""Guards on each side, for each board side by side."""


class Guarded:
    """A copy of an array between guards."""

    def __init__(self, content: Any, width: int = 1) -> None:
        content = np.ascontiguousarray(content)
        assert content.itemsize == GUARD.itemsize
        room = ROOM * width
        self._all = np.full(content.size + 2 * room, GUARD)
        self._room = room
        self.array = self._all[room : room + content.size].view(content.dtype).reshape(content.shape)
        self.array[...] = content

    def broken(self) -> list[int]:
        """Return the places, counted from the beginning of the array, of guards that have changed."""
        places = np.flatnonzero(self._all != GUARD) - self._room
        return [int(place) for place in places if not 0 <= place < self.array.size]
