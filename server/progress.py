"""Streams of progress: server-sent events of work under way, from the state in memory."""

from __future__ import annotations

import asyncio
import contextlib
from collections import Counter
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator

from fastapi.sse import format_sse_event
from pydantic import BaseModel, Field

from server.clock import Clock
from server.errors import ApiError

BEAT_S = 0.5
"""Between two looks at work under way; the end of a run needs no look."""
HEARTBEAT_S = 15.0
"""Silence after which a comment keeps the connection open."""
RETRY_MS = 2000
"""Time after which a browser connects again."""
MOST, MOST_EACH = 128, 8
"""Open streams of this server, and of one student."""
ENDS = {"done": "done", "cut_short": "done", "cancelled": "cancelled"}
"""The last event by the state of the work; `failed` in any other state."""


class WorkProgress(BaseModel):
    """How far a run, a campaign, a search or a recording is."""

    state: str
    fraction: float = Field(description="Share that is done, from 0 to 1")
    done: int = Field(description="Finished runs, or ticks of a recording")
    total: int = Field(description="Runs as far as known, or ticks at which a recording ends by itself")
    seconds_left: float | None = Field(None, description="Estimate from the time so far; null: not known yet")

    @property
    def id(self) -> str:
        """The id of its event."""
        return f"{self.state} {self.done}/{self.total} {self.fraction:.6f}"


class Ending(BaseModel):
    """The end of some work."""

    state: str
    result: BaseModel

    @property
    def id(self) -> str:
        """The id of its event."""
        return f"end {self.state}"


Look = Callable[[], Awaitable[WorkProgress | Ending | None]]
"""Returns how far some work is, or its end; None while its end is written. It refuses work that is gone."""


class ProgressStreams:
    """The open streams of progress.

    Parameters
    ----------
    clock : Clock
        Beats, and measures silence.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._bell = asyncio.Event()
        self._is_closing = False
        self.open: Counter[str] = Counter()
        """Streams by the id of their reader."""

    def ring(self) -> None:
        """Let all streams look at their work now."""
        before, self._bell = self._bell, asyncio.Event()
        before.set()

    async def run(self, clock: Clock) -> None:
        """Let all streams look at their work, again and again."""
        async for _ in clock.every(BEAT_S):
            self.ring()

    def close(self) -> None:
        """End all streams because the server stops."""
        self._is_closing = True
        self.ring()

    def check_room(self, reader: str, is_teacher: bool) -> None:
        """Refuse a stream beyond the limits."""
        is_full = self.open.total() >= MOST
        if is_full or (not is_teacher and self.open[reader] >= MOST_EACH):
            text = f"{MOST if is_full else MOST_EACH} streams of progress are open, the limit"
            raise ApiError(503, "limit", text, hint="close one, or ask for the state instead")

    @contextlib.contextmanager
    def place(self, reader: str) -> Iterator[None]:
        """Count a stream as long as it is open."""
        self.open[reader] += 1
        try:
            yield
        finally:
            self.open[reader] -= 1
            self.open += Counter()  # forgets those at 0

    async def events(self, look: Look, known: str) -> AsyncIterator[bytes]:
        """Go through the events of some work as they are sent, up to its end.

        Parameters
        ----------
        look : callable
            Returns how far the work is.
        known : str
            Id of the last event that the reader has; the same event is not sent again.
        """
        sent_at = self._clock()
        began: tuple[float, float] | None = None
        yield format_sse_event(retry=RETRY_MS)
        while not self._is_closing:
            bell = self._bell  # taken before the look, so that no ring is lost
            try:
                found, now = await look(), self._clock()
            except ApiError:
                return
            if isinstance(found, Ending):
                yield format_sse_event(
                    event=ENDS.get(found.state, "failed"), data_str=found.result.model_dump_json(), id=found.id
                )
                return
            if found is not None and began is None and found.state != "queued":
                began = now, found.fraction
            if found is not None and found.id != known:
                known, sent_at = found.id, now
                found.seconds_left = _left(found.fraction, now, began)
                yield format_sse_event(event="progress", data_str=found.model_dump_json(), id=known)
            elif now - sent_at >= HEARTBEAT_S:
                sent_at = now
                yield format_sse_event(comment="still there")
            await bell.wait()


def _left(fraction: float, now: float, began: tuple[float, float] | None) -> float | None:
    """Estimate the time to the end from the time since the beginning."""
    if began is None or fraction <= began[1]:
        return None
    return (now - began[0]) * (1.0 - fraction) / (fraction - began[1])
