"""The users of each bench and their times: finds idle benches."""

from __future__ import annotations

import time
from collections.abc import Callable

from server.bench.bench import LiveBench

EVERY_S = 5.0
"""Between two looks at the benches."""


class Idling:
    """Notes when each bench was last watched or requested.

    Parameters
    ----------
    watchers : callable
        Counts the pages that watch a bench.
    idle_minutes : float
        How long an unused bench stays; 0 is without limit.
    clock : callable
        Monotonic seconds.
    """

    def __init__(
        self, watchers: Callable[[str], int], idle_minutes: float, clock: Callable[[], float] = time.perf_counter
    ) -> None:
        self._watchers, self._patience_s, self.clock = watchers, 60.0 * idle_minutes, clock
        self._seen: dict[str, float] = {}

    def saw(self, bench_id: str) -> None:
        """Note that a bench is in use now."""
        self._seen[bench_id] = self.clock()

    def forget(self, bench_id: str) -> None:
        """Forget a bench that is gone."""
        self._seen.pop(bench_id, None)

    def left_s(self, session: LiveBench) -> float | None:
        """Return how long an unused bench still stays; None if it is needed."""
        if not self._patience_s or self._is_needed(session):
            return None
        seen = self._seen.setdefault(session.id, self.clock())
        return max(0.0, seen + self._patience_s - self.clock())

    def due(self, sessions: list[LiveBench]) -> list[LiveBench]:
        """Return the benches that may be closed now; note that the needed benches are needed."""
        for session in sessions:
            if self._is_needed(session):
                self.saw(session.id)
        return [session for session in sessions if self.left_s(session) == 0.0]

    def _is_needed(self, session: LiveBench) -> bool:
        """Say whether a bench has a watcher, is to be kept, has a view for now, or has something to come or to lose.

        Waiting commands of a paused bench are kept with it; on a running bench their moment comes. Moments that were
        kept of a bench would be lost.
        """
        recordings = session.recordings
        return (
            session.keep
            or session.view is not None
            or self._watchers(session.id) > 0
            or bool(recordings.under_way or recordings.armed or session.snapshots.all())
            or (session.is_running and len(session.board.pending) > 0)
            or bool(session.time.steps)
        )
