"""Fast forward: a bench runs as fast as it can for a while, then at its time scale; it changes no bit."""

from __future__ import annotations

from typing import Literal

from core.errors import InputError
from server.bench.live_bench import LiveBench

SHORTLY_S = 2.0
"""Wall time at the time scale that is left before the waiting command, to see the moment before."""
CAREFUL_S = 0.05
"""The same for a condition, whose moment is not known: the longest it can be overrun."""
NO_END = 2**53

Reason = Literal["quiet_lead", "skip"]


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
        return self._reason if self._bench.pacer.fast_to is not None else None

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
        bench.pacer.hurry(tick, bench.board.tick, bench.now)

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
        scale = self._bench.pacer.scale
        return 1 if scale is None else max(1, round(wall_s * scale * 1e3 / self._bench.dt_ms))
