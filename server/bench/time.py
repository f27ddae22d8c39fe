"""The time of a bench: it starts, pauses, steps and skips, keeps a pace, and pauses at the end of the scenario."""

from __future__ import annotations

import math
from collections import deque
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from core.board.board import Board
from core.errors import InputError
from core.format import format_short
from server.bench import commands
from server.bench.commands import MAX_PENDING, Step, StepPeriod
from server.bench.description import period_of
from server.bench.events import Event
from server.bench.instrument import live_record
from server.bench.pacing import Pacer
from server.metrics import Metrics

if TYPE_CHECKING:
    from server.bench.bench import LiveBench

STATUS_S = 0.2
"""Between two looks at the status of a bench that runs."""
LONGEST_PERIOD = 100_000
"""Most ticks of a step by one period of the drive."""
SHORTLY_S = 2.0
"""Wall time at the time scale that is left before the waiting command, to see the moment before."""
CAREFUL_S = 0.05
"""The same for a condition, whose moment is not known: the longest it can be overrun."""
MOST_BEHIND_S = 0.005
"""Time that a bench which plays an instrument has in each turn."""
NO_END = 2**53

Reason = Literal["quiet_lead", "skip"]


@dataclass
class StepRequest:
    """A step that a caller waits for, and how far it has come."""

    command: Step | StepPeriod
    actor: str
    start: int
    ticks: int
    ended: Future[Event] = field(default_factory=Future)
    done: int = 0

    def text(self) -> str:
        """Return in words how much of the step was done."""
        plural = "s" if self.ticks != 1 else ""
        if self.done < self.ticks:
            return f"stepped {self.done} of {self.ticks} tick{plural}"
        return f"stepped {self.ticks} tick{plural}"


class Steps:
    """The queue of steps of a bench; on the engine thread.

    Parameters
    ----------
    bench : LiveBench
        The bench.
    """

    def __init__(self, bench: LiveBench) -> None:
        self._bench = bench
        self._requests: deque[StepRequest] = deque()

    def __len__(self) -> int:
        return len(self._requests)

    def add(self, command: Step | StepPeriod, actor: str) -> Future[Event]:
        """Queue a step; return a future that holds its event when the step has ended.

        Raises
        ------
        InputError
            When the reference has no period to step by, or too many steps wait already.
        """
        if len(self) >= MAX_PENDING:
            raise InputError(f"{MAX_PENDING} steps wait for their turn already", code="limit")
        ticks = command.ticks if isinstance(command, Step) else self._period()
        last = self._requests[-1] if self._requests else None
        start = self._bench.board.tick if last is None else last.start + last.ticks
        request = StepRequest(command, actor, start, ticks)
        request.ended.set_running_or_notify_cancel()  # a caller that no longer waits does not stop the step
        self._requests.append(request)
        return request.ended

    def slice(self) -> bool:
        """Advance the first step by one slice; true while steps are queued."""
        bench, first = self._bench, self._requests[0]
        ran = bench.advance(first.ticks - first.done)
        first.done += ran
        if not ran or bench.board.trip is not None:  # the end of a recording that is played, or a trip
            self.end()
        elif first.done == first.ticks:
            self._answer(self._requests.popleft())
        return bool(self._requests)

    def end(self) -> None:
        """End all steps at this tick."""
        while self._requests:
            self._answer(self._requests.popleft())

    def _answer(self, request: StepRequest) -> None:
        """Note at the tick where a step began how much of it was done, and answer its caller."""
        command = request.command
        event = self._bench.note(request.actor, command.kind, request.text(), command.model_dump(), tick=request.start)
        self._bench.refresh_status()
        request.ended.set_result(event)

    def _period(self) -> int:
        """Return the drive period in ticks, at most the longest step allowed."""
        period = period_of(self._bench)
        if period is None:
            raise InputError("the reference has no period", "kind", "step a number of ticks", "conflict")
        return max(1, min(LONGEST_PERIOD, round(period)))


class FastForwarding:
    """The tick at which a fast-forwarding bench returns to its time scale; on the engine thread.

    Parameters
    ----------
    bench : LiveBench
        The bench.
    """

    def __init__(self, bench: LiveBench) -> None:
        self._bench = bench
        self._reason: Reason = "skip"
        self._awaited = 0
        self.leads = False
        """Whether the bench begins fast, to shortly before the first command that waits."""

    @property
    def reason(self) -> Reason | None:
        """Why the bench runs as fast as possible now, if it does."""
        return self._reason if self._bench.time.pacer.fast_to is not None else None

    def begin(self, before_tick: int | None = None) -> None:
        """Leave out the wait for a tick; without one, and if the bench leads, that for the first command that waits."""
        if before_tick:
            self._bench.note("scenario", "fast_forward", self.skip(before_tick, None))
        elif self.leads and not self._conditions() and (tick := self._bench.board.pending.next_tick) is not None:
            text = self._begin("quiet_lead", tick)
            if self.reason:
                self._bench.note("scenario", "fast_forward", f"quiet lead: {text}")

    def skip(self, before_tick: int | None, ends_at: int | None) -> str:
        """Run on to shortly before a tick, a waiting command, or the end of the scenario; return that in words.

        Raises
        ------
        InputError
            When the tick has passed, or nothing is ahead.
        """
        now = self._bench.board.tick
        if before_tick is not None and before_tick <= now:
            raise InputError(f"tick {before_tick} has passed, the bench is at {now}", "before_tick")
        tick = self._next_tick() if before_tick is None else before_tick
        if tick is not None:
            return self._begin("skip", tick)
        conditions = self._conditions()
        if not conditions and ends_at is None:
            raise InputError("nothing waits, and the scenario has no end", "before_tick", "give a tick", "conflict")
        return self._begin("skip", NO_END if conditions else ends_at or NO_END, conditions)

    def end(self) -> None:
        """Go on at the time scale, if it does not already."""
        if self.reason:
            self._hurry(None)

    def advance(self, ticks: int) -> bool:
        """Run some ticks, few at once where a condition is awaited; false once that has taken effect."""
        awaits = self._awaited > 0 and self.reason is not None
        self._bench.advance(min(ticks, self._ticks(CAREFUL_S)) if awaits else ticks)
        met = awaits and self._conditions() < self._awaited
        if met:
            self.end()
        return not met

    def _begin(self, reason: Reason, tick: int, awaited: int = 0) -> str:
        self._reason, self._awaited = reason, awaited
        if awaited:
            self._hurry(tick)
            return "as fast as possible until what waits takes effect"
        self._hurry(tick - self._ticks(SHORTLY_S))
        return f"as fast as possible to shortly before tick {tick}"

    def _hurry(self, tick: int | None) -> None:
        bench = self._bench
        bench.time.pacer.hurry(tick, bench.board.tick, bench.clock())

    def _next_tick(self) -> int | None:
        """Return the tick of the first command that is not as close already as it is to be seen from."""
        seen = self._bench.board.tick + self._ticks(SHORTLY_S)
        ticks = (entry.tick for entry in self._bench.board.pending if entry.condition is None)
        return next((tick for tick in ticks if tick is not None and tick > seen), None)

    def _conditions(self) -> int:
        """Return how many commands wait for a condition."""
        return sum(entry.condition is not None for entry in self._bench.board.pending)

    def _ticks(self, wall_s: float) -> int:
        """Return the ticks of some wall time at the time scale; one when that is as fast as possible."""
        scale = self._bench.time.pacer.scale
        return 1 if scale is None else max(1, round(wall_s * scale * 1e3 / self._bench.dt_ms))


class DeviceTime:
    """Starts and stops the time of a bench; on the engine thread.

    Parameters
    ----------
    bench : LiveBench
        The bench.
    time_scale : float or None
        Device seconds per wall second; none means as fast as possible.
    ends_at : int or None
        Tick at which the scenario ends; none for no end.
    metrics : Metrics
        Where overruns are counted.
    """

    def __init__(self, bench: LiveBench, time_scale: float | None, ends_at: int | None, metrics: Metrics) -> None:
        self._bench, self._metrics = bench, metrics
        self.pacer = Pacer(bench.dt_ms * 1e-3, time_scale)
        self.steps, self.fast_forward = Steps(bench), FastForwarding(bench)
        self.is_started = False
        """Whether time runs until it is paused."""
        self.ends_at = ends_at
        """Tick at which the bench pauses once."""
        self._most_scale = math.inf
        self._counted, self._status_due = (0, 0.0), 0.0

    @property
    def is_running(self) -> bool:
        """Whether time runs, until a pause or to the end of a step."""
        return self.is_started or bool(self.steps)

    @property
    def is_hurried(self) -> bool:
        """Whether it advances to a tick as fast as possible: steps, or a scenario that skips ahead."""
        return bool(self.steps) or self.pacer.fast_to is not None

    def limit(self, most_scale: float) -> None:
        """Allow no higher time scale than this."""
        self._most_scale = most_scale
        if self.pacer.scale is not None and self.pacer.scale > most_scale:
            self.pacer = Pacer(self.pacer.dt_s, most_scale)

    def pace(self, scale: float | None) -> None:
        """Take another time scale without an event."""
        self.pacer = Pacer(self.pacer.dt_s, scale)
        self._anchor()

    def begin(self, start: bool) -> None:
        """Begin, running or paused."""
        self.is_started, self.ends_at = start, self._ahead(self.ends_at)
        self._anchor()

    def stop(self) -> None:
        """Stop at this tick; steps end here."""
        self.is_started = False
        self.steps.end()

    def stop_if_tripped(self) -> None:
        """Stop if the board has tripped."""
        self.is_started = self.is_started and self._bench.board.trip is None

    def target(self, now: float) -> int | None:
        """Return the tick to reach in this round; the bench stops once at the end of its scenario."""
        if self.steps:
            return None
        target = self.pacer.target(self._bench.board.tick, now)
        if (record := live_record(self._bench.board)) is not None and record.is_growing:
            target = record.samples if target is None else min(target, record.samples)
        if self.ends_at is not None:
            return self.ends_at if target is None else min(target, self.ends_at)
        return target

    def slice(self, target: int | None) -> bool:
        """Advance by one slice; true while there is more to do."""
        if self.steps:
            return self.steps.slice()
        bench = self._bench
        wanted = bench.board.chunk if target is None else target - bench.board.tick
        if wanted > 0 and not self._run(wanted):
            return False
        if self.ends_at is not None and bench.board.tick >= self.ends_at and self.is_started:
            self._finish()
            return self.is_started and target is None  # a span that begins again has its target from the next round on
        return self.is_started and (target is None or bench.board.tick < target)

    def _run(self, ticks: int) -> bool:
        """Run ticks, few at once; false once an awaited command has taken effect.

        Samples of an instrument come whether the engine wakes in time or not, so a bench that plays them runs more.
        """
        bench = self._bench
        began, end = bench.clock(), bench.board.tick + ticks
        while True:
            before = bench.board.tick
            if not self.fast_forward.advance(end - before):
                return False
            ran = bench.board.tick - before
            if live_record(bench.board) is None or not 0 < ran < end - before or bench.clock() - began >= MOST_BEHIND_S:
                return True

    def finish_round(self, target: int | None, now: float) -> None:
        """Account for a round; refresh the status now and then."""
        pacer = self.pacer
        if (record := live_record(self._bench.board)) is not None:
            record.arrivals.played(self._bench.board.tick, now)
        if self.is_started:
            pacer.record(self._bench.board.tick, target if pacer.scale is not None else None, now)
        overruns, given_up = self._counted
        self._metrics.overruns.inc(max(0, pacer.overruns - overruns))
        self._metrics.given_up_seconds.inc(max(0.0, pacer.given_up_s - given_up))
        self._counted = (pacer.overruns, pacer.given_up_s)
        if now >= self._status_due:
            self._status_due = now + STATUS_S
            self._bench.refresh_status()

    def jumped(self, ends_at: int | None) -> None:
        """Follow a jump in time: steps end, the clock is anchored anew, and the scenario ends at this tick."""
        self.steps.end()
        self.fast_forward.end()
        self.ends_at = self._ahead(ends_at)
        if (dt_s := self._bench.dt_ms * 1e-3) != self.pacer.dt_s:
            self.pacer = Pacer(dt_s, self.pacer.scale)
        self.stop_if_tripped()
        self._anchor()

    def carry_out(self, command: commands.RunsTime, actor: str) -> Event | Future[Event]:
        """Carry out a command to time; for a step, return a future that holds its event at its end.

        Raises
        ------
        InputError
            If the command cannot be carried out; nothing has changed then.
        """
        document, trip = command.model_dump(), self._bench.board.trip
        if isinstance(command, commands.Seek | commands.Loop | commands.Reset):
            raise InputError("only a recording that is played can do that", "kind", code="conflict")
        if isinstance(command, commands.TimeScale):
            return self._rescale(command, actor)
        if isinstance(command, commands.Pause):
            self.stop()
            return self._bench.note(actor, "pause", "paused", document)
        if trip is not None:
            raise InputError(f"the board has tripped: {trip.reason}", hint="reset the trip first", code="tripped")
        if isinstance(command, commands.Start | commands.FastForward):
            skips = isinstance(command, commands.FastForward) and self.fast_forward.skip(
                command.before_tick, self.ends_at
            )
            self.steps.end()
            self.is_started = True
            self._anchor()
            return self._bench.note(actor, command.kind, skips or "started", document)
        assert isinstance(command, commands.Step | commands.StepPeriod)
        ended = self.steps.add(command, actor)
        self.is_started = False
        return ended

    def _rescale(self, command: commands.TimeScale, actor: str) -> Event:
        """Change how fast device time runs."""
        bench, old, new = self._bench, self.pacer.scale, command.value
        if new is not None and new > self._most_scale:
            most = format_short(self._most_scale, "s/s")
            raise InputError(f"the benches of a class run at {most} at most", "value", code="limit")
        self.pacer.rescale(new, bench.board.tick, bench.clock(), self.is_started)
        text = f"time scale set to {format_short(new, 's/s')}" if new else "time runs as fast as possible"
        return bench.events.add(bench.board.tick, actor, "time_scale", text, command.model_dump(), old, new)

    def _finish(self) -> None:
        """Pause at the end of the scenario; starting again goes beyond it."""
        self.is_started, self.ends_at = False, None
        is_record = isinstance(self._bench.board, Board) and self._bench.board.spec.record is not None
        text = "the record is played to its end" if is_record else "scenario finished; run to continue"
        self._bench.note("scenario", "finished", text)
        self._bench.refresh_status()

    def _ahead(self, tick: int | None) -> int | None:
        return tick if tick is not None and self._bench.board.tick < tick else None

    def _anchor(self) -> None:
        self.pacer.anchor(self._bench.board.tick, self._bench.clock())
