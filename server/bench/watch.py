"""Somebody who looks at a bench at ticks of its own, such as a lab sheet for the step that is open."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from core.board.document import Document
from server.bench.live_bench import LiveBench


@dataclass(frozen=True)
class KeptWatch:
    """How far somebody is who looks at a bench, as plain data: from it another goes on at the same tick.

    Parameters
    ----------
    document : dict
        JSON can hold all of it.
    samples : ndarray
        What was seen of the last ticks, ticks by signals.
    """

    document: Document
    samples: NDArray[np.float32] = field(repr=False)


class Watch(Protocol):
    """Looks at a bench at ticks of its own; on the engine's thread."""

    def room(self, tick: int, ticks: int) -> int:
        """Return how far the bench may run at a time."""

    def jumped(self, tick: int) -> None:
        """Hear that the bench has gone to a tick: it was reset, or restored."""

    def look(self, bench: LiveBench) -> None:
        """Look at the bench after it has run."""

    def kept(self, bench: LiveBench) -> KeptWatch:
        """Return how far it is, at the tick of the bench."""
