"""Hiding: a bench hides a fault, and users have a view of the bench that does not reveal it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from core.board.commands import Heal, Inject, Set, Switch, Trip
from core.board.document import Document
from core.board.history import History
from core.board.rows import Rows
from core.device.catalogue import device
from core.device.device import Device
from core.errors import unknown
from core.signals import Signal
from scenarios.narrator.doings import MEASURED
from server.bench.blind import ACTOR, GAME_HINT, MAY_SET, Blind
from server.bench.captures import Captures
from server.bench.description import bench_of, document_now
from server.bench.events import Event, EventLog
from server.bench.narration import Narration
from server.bench.status import Bench, BenchStatus
from server.errors import ApiError
from server.security.person import Person

if TYPE_CHECKING:
    from server.bench.bench import LiveBench

STOPPED = "the board has stopped itself"
"""The only words about a trip: its reason and its signal would reveal the fault."""

RUNNING = ("opened", "start", "pause", "step", "step_period", "reset_trip", "finished", "blind")
CHANGES, TRIED = ("time_scale", Set.kind, Switch.kind), (Inject.kind, Heal.kind)
"""Kinds of visible events; changes without the values before, trips only as a stop of the board. In a game that allows
faults, the tried faults are visible too."""

STATUS = (
    *("state", "tick", "first_tick", "time_scale", "achieved_scale", "capped", "overruns", "given_up_ms"),
    *("controller", "slots", "watchers", "is_stuck", "loop_lag_ms", "wake_late_ms"),
)
BENCH = (
    *("id", "title", "scenario_id", "source", "created", "dt_ms", "sample_rate_khz", "samples", "history_ticks"),
    *("drive_period_ticks", "axes", "controllers", "keep"),
)
"""The visible fields of a status and of a bench; all others are hidden."""


class Hiding:
    """The hidden fault of a bench, if it has one.

    Parameters
    ----------
    bench : LiveBench
        The bench.
    """

    def __init__(self, bench: LiveBench) -> None:
        self._bench = bench
        self.view: BlindView | None = None
        """The view that people have while a fault is hidden."""
        self.since = 0
        """Number of the first event that came then."""

    @property
    def blind(self) -> Blind | None:
        """The hidden fault."""
        return self.view.blind if self.view is not None else None

    def hides_from(self, person: Person) -> bool:
        """Whether a person sees only the view; a teacher sees all of the bench of a student."""
        return self.view is not None and not (self._bench.class_id and person.is_teacher)

    def begin(self, blind: Blind, log: Sequence[Event] = ()) -> None:
        """Serve the view alone from now on; after a crash, with the log since then."""
        self.view = BlindView(self._bench, blind)
        self.since = log[0].seq if log else self._bench.events.last + 1
        for event in log:
            self.hear(event)

    def clear(self) -> None:
        """Heal the device, drop waiting commands and end recordings: all could reveal the fault (an engine job)."""
        bench = self._bench
        bench.time.fast_forward.end()
        bench.time.fast_forward.leads = False
        bench.recordings.close("a fault was hidden")
        bench.board.pending.clear()
        bench.board.apply(Heal(heal="all"), ACTOR)
        bench.done_otherwise()

    def inject(self, actor: str) -> None:
        """Let the fault wait for its moment (a job of the engine)."""
        assert self.blind is not None
        self.blind.inject(self._bench.board)
        self._bench.done_otherwise()
        text = "a fault was hidden, or none" if self.blind.question.game is None else "a game began"
        self._bench.note(actor, "blind", text)
        self._bench.refresh_status()

    def reveal(self, actor: str) -> None:
        """Serve everything again (a job of the engine)."""
        self.view = None
        self._bench.note(actor, "revealed", "the hidden fault was shown")
        self._bench.refresh_status()

    def look(self, rows: Rows) -> None:
        """Let the narrator of the view see the signals of some rows that people may see."""
        if self.view is not None:
            self.view.narration.look(rows)

    def hear(self, event: Event) -> bool:
        """Put an event of the bench into the log of the view, if it may go there; return whether a fault is hidden."""
        if self.view is not None:
            self.view.hear(event)
        return self.view is not None


class BlindView:
    """The visible part of a bench while a fault is hidden on it: the server serves only the names of this class.

    Parameters
    ----------
    bench : LiveBench
        The bench.
    blind : Blind
        The hidden fault.
    """

    def __init__(self, bench: LiveBench, blind: Blind) -> None:
        self._bench, self.blind = bench, blind
        self.events = EventLog(lambda _event: None)
        signals = bench.board.signals
        # the presence and the delay of the measured error depend on the hidden values
        told = [signal for signal in self.signals if signal.name != MEASURED]
        self.narration = Narration(bench.board.spec, told, signals.outputs)
        self.captures = Captures(bench, bench.captures.most_bytes)
        self._known: tuple[BenchStatus, int] | None = None
        self._status: BenchStatus | None = None

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
        return [signal for signal in self._bench.signals if self.blind.may_see(signal.name)]

    def nominal(self) -> Device:
        """Return the device as it is meant to be, which a sweep takes for known.

        Raises
        ------
        ApiError
            In a game, whose device is to be found without a sweep.
        """
        if self.blind.question.game is not None:
            raise ApiError(403, "blind", "a sweep is no part of the game", hint=GAME_HINT)
        return device(self.blind.sheet["device"])

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
            self._known, self._status = (whole, last), self._told(whole)
        return self._status

    @property
    def document(self) -> Document:
        """The bench as it is meant to be, with the reference and the controller of now."""
        now = document_now(self._bench)
        free = (*MAY_SET, "diagnosers") if self.blind.question.game is not None else MAY_SET  # as the player set it
        return {**self.blind.sheet, **{key: now[key] for key in free if key in now}}

    def describe(self, around: dict[str, Any], _view3d: str | None) -> Bench:
        """Describe the bench."""
        whole = bench_of(self._bench, around, None)
        return Bench(
            **{**dict(self._told(whole)), **{name: getattr(whole, name) for name in BENCH}},
            seed=0,
            signals=list(self.signals),
            diagnosers={name: whole.diagnosers[name] for name in self.blind.question.shows},
            parameters=self.document,
            view3d=None,
            blind=self.blind.question,
        )

    def hear(self, event: Event) -> None:
        """Take an event into this log, if people may see it."""
        if event.kind == "tripped":
            self._keep(event, text=STOPPED)
        elif event.kind in (*CHANGES, *(TRIED if self.blind.may_inject else ())):
            self._keep(event, text=event.text, command=event.command, old=event.old, new=event.new)
        elif event.kind in RUNNING:
            self._keep(event, text=event.text, command=event.command)

    def told(self, event: Event) -> Event:
        """Return an event of the bench as this log has it."""
        return next(one for one in reversed(self.events.after(0)[1]) if one.at == event.at)

    def _keep(self, event: Event, **told: Any) -> None:
        self.narration.hear(self.events.keep(tick=event.tick, actor=event.actor, kind=event.kind, at=event.at, **told))
        self.narration.tell()

    def _told(self, whole: BenchStatus) -> BenchStatus:
        """Return the parts of a status that people may see."""
        stopped = whole.trip
        if stopped is not None:
            stopped = Trip(tick=stopped.tick, time_ms=stopped.time_ms, reason=STOPPED, signal="", value=None)
        return BenchStatus(
            **{name: getattr(whole, name) for name in STATUS},
            fast_forward=None,
            faults=whole.faults if self.blind.may_inject else [],
            pending=[],
            trip=stopped,
            scores={},
            last_event=self.events.last,
            recording=[],
            armed=[],
        )
