"""A view and a watch of a bench: the part that people may see for a while, and a look at ticks of its own.

An exercise, a game or a lab sheet gives them to a bench, which knows none of these.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from core.board.document import Document
from core.board.history import History
from core.errors import InputError, unknown
from core.signals import Signal
from server.bench.captures import Captures
from server.bench.description import bench_of, document_now
from server.bench.events import Event, EventLog
from server.bench.narration import Narration
from server.bench.status import Bench, BenchStatus

if TYPE_CHECKING:
    from server.bench.bench import LiveBench


class Rules(Protocol):
    """The visible part of a bench, and the commands that are free."""

    def model_dump(self) -> Document:
        """Return the rules as plain data, for the checkpoint of the bench."""

    def may_see(self, signal: str) -> bool:
        """Whether a signal is served."""

    def may_tell(self, signal: str) -> bool:
        """Whether the narrator may use a signal that is served."""

    def event(self, event: Event) -> Document | None:
        """Return the visible fields of an event beside its tick, actor and kind; None hides all of it."""

    def status(self, whole: BenchStatus, last_event: int) -> BenchStatus:
        """Return the visible part of a status, with the number of the last visible event."""

    def bench(self, whole: Bench, last_event: int) -> Bench:
        """Return the visible part of a description."""

    def document(self, whole: Document) -> Document:
        """Return the visible part of the document of the bench as it is now."""

    def check(self, command: Any) -> None:
        """Refuse a command that is not free."""

    def refusal(self, error: InputError) -> InputError:
        """Return the error of a command as people may read it."""


class View:
    """A bench as people see it while rules hide a part of it: the server serves only the names of this class.

    Parameters
    ----------
    bench : LiveBench
        The bench.
    rules : Rules
        Name the visible part.
    log : sequence of Event
        Events of the bench since it has the rules, after a crash.
    """

    def __init__(self, bench: LiveBench, rules: Rules, log: Sequence[Event] = ()) -> None:
        self._bench, self.rules = bench, rules
        self.since = log[0].seq if log else bench.events.last + 1
        """Number of the first event of the bench since it has the rules."""
        self.events = EventLog(lambda _event: None)
        told = [signal for signal in self.signals if rules.may_tell(signal.name)]
        self.narration = Narration(bench.board.spec, told)
        self.captures = Captures(bench, bench.captures.most_bytes)
        self._known: tuple[BenchStatus, int] | None = None
        self._status: BenchStatus | None = None
        for event in log:
            self.hear(event)

    @property
    def id(self) -> str:
        """Of the bench."""
        return self._bench.id

    @property
    def dt_ms(self) -> float:
        """Device time of one tick."""
        return self._bench.dt_ms

    @property
    def history(self) -> History:
        """All samples; `indices` gives the columns of signals that may be seen."""
        return self._bench.history

    @property
    def is_running(self) -> bool:
        """Whether time runs."""
        return self._bench.is_running

    @property
    def scenario_id(self) -> str:
        """Id of its scenario, for the names of files."""
        return self._bench.scenario.id

    @property
    def about(self) -> Document:
        """Description in a file of its trace."""
        return {"bench": self.id}

    @property
    def signals(self) -> Sequence[Signal]:
        """The signals that may be seen."""
        return [signal for signal in self._bench.signals if self.rules.may_see(signal.name)]

    def indices(self, names: Sequence[str]) -> list[int]:
        """Return the columns of signals; a hidden signal is unknown."""
        known = {signal.name: signal.index for signal in self.signals}
        for name in names:
            if name not in known:
                raise unknown("signal", name, list(known), "signals")
        return [known[name] for name in names]

    @property
    def status(self) -> BenchStatus:
        """The status, the same object until something of it changes."""
        whole, last = self._bench.status, self.events.last
        if self._status is None or self._known is None or self._known[0] is not whole or self._known[1] != last:
            self._known, self._status = (whole, last), self.rules.status(whole, last)
        return self._status

    @property
    def document(self) -> Document:
        """The visible part of the document of the bench as it is now."""
        return self.rules.document(document_now(self._bench))

    def describe(self, around: dict[str, Any], _view3d: str | None) -> Bench:
        """Describe the bench."""
        return self.rules.bench(bench_of(self._bench, around, None), self.events.last)

    def hear(self, event: Event) -> None:
        """Take an event of the bench into this log, if people may see it."""
        if (told := self.rules.event(event)) is not None:
            fields = {"tick": event.tick, "actor": event.actor, "kind": event.kind, "at": event.at, **told}
            self.narration.hear(self.events.keep(**fields))
            self.narration.tell()

    def told(self, event: Event) -> Event:
        """Return an event of the bench as this log has it."""
        return next(one for one in reversed(self.events.after(0)[1]) if one.at == event.at)


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
