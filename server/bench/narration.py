"""The sentences of the narrator about a live bench; the event loop reads them."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import islice

from core.board.kept import Ticks
from core.board.log import Log
from core.board.spec import Spec
from core.signals import Signal
from scenarios.narrator.narrator import Narrator
from scenarios.narrator.sentence import Sentence
from server.bench.events import Event

KEPT = 2000
"""Sentences kept of a run."""


@dataclass(frozen=True)
class Told:
    """The sentences up to a moment, and a narrator that continues from there.

    Parameters
    ----------
    narrator : Narrator
        Goes on from the moment.
    sentences : tuple of Sentence
        The last sentences before it.
    last : int
        Number of the last of them.
    earlier : dict
        The narrator at ticks before it, with the number of the last sentence said by then.
    """

    narrator: Narrator
    sentences: tuple[Sentence, ...]
    last: int
    earlier: dict[int, tuple[Narrator, int]]

    def at(self, tick: int) -> Told:
        """Return the sentences up to a remembered tick, to continue from there."""
        narrator, last = self.earlier[tick]
        known = last - (self.last - len(self.sentences))
        earlier = {one: then for one, then in self.earlier.items() if one <= tick}
        return Told(narrator, self.sentences[: max(known, 0)], last, earlier)


@dataclass(frozen=True)
class NarrationPlace:
    """How far a narration is: how often the bench has jumped, and the number of the last sentence since it began."""

    jumps: int = -1
    last: int = 0


class Narration:
    """The sentences of the present run of a bench, numbered 1, 2, 3, ...; a jump removes the sentences that it undoes.

    Parameters
    ----------
    spec : Spec
        The bench as it begins.
    signals : sequence of Signal
        The signals that sentences may use.
    """

    def __init__(self, spec: Spec, signals: Iterable[Signal]) -> None:
        self._signals = list(signals)
        self._lock = threading.Lock()
        self._sentences: deque[Sentence] = deque(maxlen=KEPT)
        self._narrator = Narrator(spec, self._signals)
        self._earlier: dict[int, tuple[Narrator, int]] = {}
        self.mark = NarrationPlace(0, 0)

    def hear(self, event: Event) -> None:
        """Take an event of the bench."""
        self._narrator.hear(event)

    def look(self, rows: Ticks) -> None:
        """Write the sentences after some more rows."""
        self.say(self._narrator.look(rows))

    def follow(self, log: Log, rows: Ticks | None = None) -> None:
        """Write the sentences after some more rows of a board that is computed again, which has a log of its own."""
        self.say(self._narrator.follow(log, rows))

    def tell(self) -> None:
        """Write sentences at once that wait for no row, for example that the board was stopped."""
        self.say(self._narrator.tell())

    def say(self, sentences: Sequence[Sentence]) -> None:
        """Add sentences."""
        if sentences:
            with self._lock:
                self._sentences.extend(sentences)
                self.mark = NarrationPlace(self.mark.jumps, self.mark.last + len(sentences))

    def remember(self, tick: int, kept: Collection[int]) -> None:
        """Remember the sentences at a tick; of the ticks before, only the kept ticks."""
        earlier = {one: known for one, known in self._earlier.items() if one in kept and one < tick}
        self._earlier = {**earlier, tick: (self._narrator.copy(), self.mark.last)}

    def told(self) -> Told:
        """Return the sentences so far, to continue from."""
        return Told(self._narrator.copy(), tuple(self._sentences), self.mark.last, self._earlier)

    def go_to(self, told: Told | None, spec: Spec) -> None:
        """Continue from the sentences at a moment; without them, begin again with the bench."""
        if told is None:
            self._jump(Told(Narrator(spec, self._signals), (), 0, {}))
        else:
            self._jump(replace(told, narrator=told.narrator.copy()))

    def _jump(self, told: Told) -> None:
        with self._lock:
            self._narrator = told.narrator
            self._sentences = deque(told.sentences, maxlen=KEPT)
            self._earlier = told.earlier
            self.mark = NarrationPlace(self.mark.jumps + 1, told.last)

    def after(self, known: NarrationPlace) -> tuple[NarrationPlace, int, list[Sentence]]:
        """Return how far the narration is, the number before the first sentence returned, and those not known yet.

        Parameters
        ----------
        known : Mark
            The progress of the caller; after a jump it has nothing.
        """
        with self._lock:
            have = known.last if known.jumps == self.mark.jumps else 0
            first = self.mark.last - len(self._sentences)
            start = max(have - first, 0)
            return self.mark, min(first + start, self.mark.last), list(islice(self._sentences, start, None))
