"""A watch looks at a bench at ticks of its own, such as a lab sheet for the step that is open."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from core.board.document import Document

if TYPE_CHECKING:
    from server.bench.bench import LiveBench


@dataclass(frozen=True)
class KeptWatch:
    """The progress of a watch, as plain data: from it another watch continues at the same tick.

    Parameters
    ----------
    document : dict
        Numbers, texts, lists and tables, as JSON has them.
    samples : ndarray
        Signals of the last ticks, ticks by signals.
    """

    document: Document
    samples: NDArray[np.float32] = field(repr=False)


class Watch(Protocol):
    """Looks at a bench at ticks of its own; on the engine's thread."""

    def room(self, tick: int, ticks: int) -> int:
        """Return how far the bench may run at a time."""

    def jumped(self, tick: int) -> None:
        """Go on from this tick: the bench was reset, or restored."""

    def look(self, bench: LiveBench) -> None:
        """Look at the bench after it has run."""

    def kept(self, bench: LiveBench) -> KeptWatch:
        """Return how far it has come, at the tick of the bench."""
