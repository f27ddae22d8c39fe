"""Steps of a bench: a number of ticks, taken in the same slices of the engine as the ticks of a running bench."""

from __future__ import annotations

from collections import deque
from concurrent.futures import Future
from dataclasses import dataclass, field

from core.errors import InputError
from server.bench.commands import MAX_PENDING, Step, StepPeriod
from server.bench.events import Event
from server.bench.live_bench import LiveBench

LONGEST_PERIOD = 100_000
"""Most ticks of a step by one period of the drive."""


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
        period = self._bench.drive_period_ticks
        if period is None:
            raise InputError("the reference has no period", "kind", "step a number of ticks", "conflict")
        return max(1, min(LONGEST_PERIOD, round(period)))
