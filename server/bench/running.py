"""How time runs on a bench: it starts, pauses, steps and skips, keeps a pace, and pauses at the end of the scenario."""

from __future__ import annotations

import math
from concurrent.futures import Future

from core.errors import InputError
from core.format import format_short
from server.bench import commands
from server.bench.events import Event
from server.bench.fast_forward import FastForwarding
from server.bench.live_bench import LiveBench
from server.bench.pacing import Pacer
from server.bench.steps import Steps
from server.metrics import Metrics

STATUS_S = 0.2
"""Between two looks at the status of a bench that runs."""


class Running:
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
        if self.ends_at is not None:
            return self.ends_at if target is None else min(target, self.ends_at)
        return target

    def slice(self, target: int | None) -> bool:
        """Advance by one slice; true while there is more to do."""
        if self.steps:
            return self.steps.slice()
        bench = self._bench
        wanted = bench.board.chunk if target is None else target - bench.board.tick
        if wanted > 0 and not self.fast_forward.advance(wanted):
            return False
        if self.ends_at is not None and bench.board.tick >= self.ends_at and self.is_started:
            self._finish()
            return self.is_started and target is None  # a span that begins again has its target from the next round on
        return self.is_started and (target is None or bench.board.tick < target)

    def finish_round(self, target: int | None, now: float) -> None:
        """Account for a round; refresh the status now and then."""
        pacer = self.pacer
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
        if isinstance(command, commands.Seek | commands.Loop):
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
        ended = self.steps.add(command, actor)
        self.is_started = False
        return ended

    def _rescale(self, command: commands.TimeScale, actor: str) -> Event:
        """Change how fast device time runs."""
        bench, old, new = self._bench, self.pacer.scale, command.value
        if new is not None and new > self._most_scale:
            most = format_short(self._most_scale, "s/s")
            raise InputError(f"the benches of a class run at {most} at most", "value", code="limit")
        self.pacer.rescale(new, bench.board.tick, bench.now, self.is_started)
        text = f"time scale set to {format_short(new, 's/s')}" if new else "time runs as fast as possible"
        return bench.events.add(bench.board.tick, actor, "time_scale", text, command.model_dump(), old, new)

    def _finish(self) -> None:
        """Pause at the end of the scenario; starting again goes beyond it."""
        self.is_started, self.ends_at = False, None
        self._bench.note("scenario", "finished", "scenario finished; run to continue")
        self._bench.refresh_status()

    def _ahead(self, tick: int | None) -> int | None:
        return tick if tick is not None and self._bench.board.tick < tick else None

    def _anchor(self) -> None:
        self.pacer.anchor(self._bench.board.tick, self._bench.now)
