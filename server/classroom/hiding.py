"""Hiding: while a bench hides a fault or plays a game, people see the part of it that does not reveal it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pydantic import BaseModel, Field

from core.board.commands import HealFaults, Inject, ResetTrip, SetValues, Switch, Trip
from core.board.document import Document
from core.device.catalogue import device
from core.device.device import Device
from core.errors import InputError
from scenarios.narrator.doings import MEASURED
from server.bench import commands
from server.bench.bench import LiveBench
from server.bench.checkpoints import Kept
from server.bench.events import Event
from server.bench.status import Bench, BenchStatus, HiddenQuestion
from server.bench.view import View
from server.errors import ApiError

ACTOR = "board"
"""Actor of the hidden fault in the log."""

COMMANDS = (
    commands.Start,
    commands.Pause,
    commands.Step,
    commands.StepPeriod,
    commands.TimeScale,
    SetValues,
    Switch,
    ResetTrip,
)
"""Commands that are allowed meanwhile: to time, to the reference and to the controller."""
MAY_SET = ("reference", "controller", "controllers")
"""First words of the parameters that may be set meanwhile."""

SIGNALS = ("reference", "sensor", "drive", "model.displacement", "model.velocity")
"""Signals that people see meanwhile: reference, measurement and drive; `model` follows the reference alone."""
OF_A_DIAGNOSER = ("probability", "winner", "residual", "nis", "information", "unexcited", "least_nis", "unexplained")
"""Ports of a diagnoser that may be seen if the exercise adds it; its score knows the truth."""

REFUSAL = "a fault is hidden on this bench"
HINT = "answer or give up first, under Lesson › Hidden fault"
GAME_HINT = "hand in or end the game first, under Lesson › Games"

STOPPED = "the board has stopped itself"
"""The only words about a trip: its reason and its signal would reveal the fault."""

RUNNING = ("opened", "start", "pause", "step", "step_period", "reset_trip", "finished", "blind")
CHANGES, TRIED = ("time_scale", SetValues.kind, Switch.kind), (Inject.kind, HealFaults.kind)
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


class Blind(BaseModel):
    """A hidden fault: the question and its possible answers, and the rules of the view meanwhile."""

    question: HiddenQuestion
    truth: str
    came_tick: int | None = Field(description="When the fault comes; null for a healthy device")
    faults: list[Document]
    sheet: Document
    may_set: list[str] = Field([], description="In a game: further parameters that may be set")
    may_inject: list[str] = Field([], description="In a game without hidden faults: the faults that may be tried")

    def may_see(self, signal: str) -> bool:
        """Whether a signal is served meanwhile."""
        block, _, port = signal.partition(".")
        if block in self.question.shows:
            return port.partition(".")[0] in OF_A_DIAGNOSER
        return block in SIGNALS or signal in SIGNALS

    def may_tell(self, signal: str) -> bool:
        """Whether the narrator may use it: presence and delay of the measured error depend on the hidden values."""
        return signal != MEASURED

    def event(self, event: Event) -> Document | None:
        """Return the visible fields of an event."""
        if event.kind == "tripped":
            return {"text": STOPPED}
        if event.kind in (*CHANGES, *(TRIED if self.may_inject else ())):
            return {"text": event.text, "command": event.command, "old": event.old, "new": event.new}
        return {"text": event.text, "command": event.command} if event.kind in RUNNING else None

    def status(self, whole: BenchStatus, last_event: int) -> BenchStatus:
        """Return the parts of a status that people may see."""
        stopped = whole.trip
        if stopped is not None:
            stopped = Trip(tick=stopped.tick, time_ms=stopped.time_ms, reason=STOPPED, signal="", value=None)
        return BenchStatus(
            **{name: getattr(whole, name) for name in STATUS},
            fast_forward=None,
            faults=whole.faults if self.may_inject else [],
            pending=[],
            trip=stopped,
            scores={},
            last_event=last_event,
            recording=[],
            armed=[],
        )

    def bench(self, whole: Bench, last_event: int) -> Bench:
        """Return the parts of a description that people may see."""
        return Bench(
            **{**dict(self.status(whole, last_event)), **{name: getattr(whole, name) for name in BENCH}},
            seed=0,
            signals=[signal for signal in whole.signals if self.may_see(signal.name)],
            diagnosers={name: whole.diagnosers[name] for name in self.question.shows},
            parameters=self.document(whole.parameters),
            view3d=None,
            blind=self.question,
        )

    def document(self, whole: Document) -> Document:
        """Return the bench as it is meant to be, with the reference and the controller of now."""
        free = (*MAY_SET, "diagnosers") if self.question.game is not None else MAY_SET  # as the player set it
        return {**self.sheet, **{key: whole[key] for key in free if key in whole}}

    def check(self, command: Any) -> None:
        """Refuse a command that would reveal or change the hidden fault.

        Raises
        ------
        ApiError
            The same line for all of them.
        """
        tries = bool(self.may_inject) and isinstance(command, Inject | HealFaults)
        is_free = tries or isinstance(command, COMMANDS)
        if isinstance(command, SetValues | Switch | ResetTrip | Inject | HealFaults):
            is_free &= command.at_sample is None and command.at_ms is None and command.when is None
        if isinstance(command, SetValues):
            is_free &= all(path.partition(".")[0] in MAY_SET or path in self.may_set for path in command.set)
        if isinstance(command, Inject):
            is_free &= command.fault in self.may_inject
        if not is_free and self.question.game is not None:
            raise ApiError(403, "blind", "this is not free to change in the game", hint=GAME_HINT)
        if not is_free:
            raise refusal("only time, the reference and the controller may be changed")

    def refusal(self, error: InputError) -> InputError:
        """Return the error of a command; after a trip it has no reason."""
        return InputError(STOPPED, hint=error.hint, code=error.code) if error.code == "tripped" else error

    def nominal(self) -> Device:
        """Return the device as it is meant to be, which a sweep takes for known.

        Raises
        ------
        ApiError
            In a game, whose device is to be found without a sweep.
        """
        if self.question.game is not None:
            raise ApiError(403, "blind", "a sweep is no part of the game", hint=GAME_HINT)
        return device(self.sheet["device"])


def refusal(what: str = "") -> ApiError:
    """Refuse a request that would reveal the fault."""
    return ApiError(403, "blind", f"{REFUSAL}; {what}" if what else REFUSAL, hint=HINT)


def blind_of(bench: LiveBench) -> Blind | None:
    """Return the hidden fault of a bench, if it has one."""
    rules = view.rules if (view := bench.view) is not None else None
    return rules if isinstance(rules, Blind) else None


def clear(bench: LiveBench) -> None:
    """Heal the device, drop waiting commands and end recordings: all could reveal the fault (a job of the engine)."""
    bench.time.fast_forward.end()
    bench.time.fast_forward.leads = False
    bench.recordings.close("a fault was hidden")
    bench.board.pending.clear()
    bench.board.apply(HealFaults(heal="all"), ACTOR)
    bench.done_otherwise()


def hide_on(bench: LiveBench, blind: Blind, actor: str) -> None:
    """Serve the view alone from now on, and let the fault wait for its moment (a job of the engine)."""
    bench.view = View(bench, blind)
    for fault in blind.faults:
        bench.board.apply(Inject(**fault, at_sample=blind.came_tick), ACTOR)
    bench.done_otherwise()
    bench.note(actor, "blind", "a fault was hidden, or none" if blind.question.game is None else "a game began")
    bench.refresh_status()


def from_the_start(choose: Callable[[LiveBench], Blind] | None) -> Callable[[LiveBench], None]:
    """Return the function that hides a chosen fault on a bench before its first tick, or nothing."""
    return lambda bench: None if choose is None else hide_on(bench, choose(bench), "teacher")


def hide_again(bench: LiveBench, kept: Kept) -> None:
    """Serve the view alone again after a crash, with its log."""
    if kept.head.rules is not None:
        log = [event for event in kept.events if event.seq >= kept.head.rules_since]
        bench.view = View(bench, Blind.model_validate(kept.head.rules), log)


def reveal(bench: LiveBench, actor: str) -> None:
    """Serve everything again (a job of the engine)."""
    bench.view = None
    bench.note(actor, "revealed", "the hidden fault was shown")
    bench.refresh_status()
