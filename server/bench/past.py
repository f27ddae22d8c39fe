"""The past of a bench: the data to compute a moment of it again, away from the engine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from core.board.board import Board
from core.board.history import History
from core.board.log import Log
from core.board.track import Passage, Track
from core.errors import InputError
from scenarios.schema import Scenario
from server.bench.events import Event
from server.bench.maker import Maker
from server.bench.narration import Told
from server.bench.session import Session
from server.bench.status import Origin


@dataclass(frozen=True)
class Past:
    """A moment of the past of a bench.

    Parameters
    ----------
    of : Session
        The bench, which continues.
    scenario : Scenario
        The scenario of the bench.
    passage : Passage
        The way to the moment. The visible part before it comes from ``seen``, or the way begins as much earlier.
    track : Track
        The track of the bench, not followed any further.
    events : list of Event
        The events of the bench, also after the moment.
    told : Told
        The sentences of the narrator at the beginning of the way.
    time_scale : float or None
        Its pace.
    origin : Origin
        The bench and the tick.
    seen : History or None
        The samples of the bench, if they go back as far as the panels look.
    jumps : int
        How often the bench had jumped in time; samples that are read after one more may be of another past.
    is_before : bool
        The commands at that very tick are left out.
    """

    of: Session
    scenario: Scenario
    passage: Passage
    track: Track
    events: list[Event]
    told: Told
    time_scale: float | None
    origin: Origin
    seen: History | None
    jumps: int
    is_before: bool = False

    @classmethod
    def take(cls, session: Session, tick: int, window_ticks: int, *, is_before: bool = False) -> Past:
        """Take the necessary data of a bench (a job of the engine).

        Parameters
        ----------
        session : Session
            The bench.
        tick : int
            The moment, with all that was done at that tick unless it is before it.
        window_ticks : int
            Ticks before the moment that are included.
        is_before : bool
            Leave out the commands at that very tick.

        Raises
        ------
        InputError
            For a tick that is not kept or has not come yet, and for a recording that is played.
        """
        track = session.track
        if track is None:
            raise InputError("a recording that is played has no past to go to", "tick", "seek in it", "conflict")
        now = session.board.tick
        if tick > now:
            raise InputError(f"tick {tick} has not come yet, the bench is at {now}", "tick")
        begin, history = max(tick - window_ticks, track.first_tick), session.history
        seen = history if history.first_tick <= begin and tick <= history.end_tick else None
        passage = track.to(tick, 0 if seen else window_ticks, is_before=is_before)
        return cls(
            of=session,
            scenario=session.scenario,
            passage=passage,
            track=track.copy(),
            events=session.events.after(0)[1],
            told=session.narration.told_at(passage.checkpoint.tick),
            time_scale=session.pacer.scale,
            origin=Origin(bench=session.id, tick=tick, window_ticks=window_ticks),
            seen=seen,
            jumps=session.narration.mark.jumps,
            is_before=is_before,
        )

    def is_true(self) -> bool:
        """Whether the bench has not jumped since, so that the samples are of this past (a job of the engine)."""
        return self.seen is None or (self.of.history is self.seen and self.of.narration.mark.jumps == self.jumps)

    def session(self, maker: Maker, on_share: Callable[[float], None]) -> Session:
        """Compute the moment again, and return a bench that can continue from it.

        Parameters
        ----------
        maker : Maker
            Makes the bench.
        on_share : callable
            Called with the share of the ticks that is done; it may raise to end it.
        """
        board = Board.restore(self.passage.checkpoint)
        session = maker.around(self.scenario, board, self.time_scale)
        session.narration.go_to(self.told)
        if self.seen is not None:
            session.history.adopt(self.seen, self.origin.tick - self.origin.window_ticks, board.tick)
        for rows in self.passage.walk(board):
            session.history.append(rows)
            session.narration.follow(board.log, rows)
            on_share((board.tick - self.passage.checkpoint.tick) / self.passage.ticks)
        session.narration.follow(board.log)
        board.log = Log()  # the log of the bench has it all
        session.events.go_on(self.events)
        session.taken_over = session.events.last
        session.track = self.track.until(board)
        session.origin = self.origin
        session.look_back("api", is_before=self.is_before)
        session.refresh_status()
        return session
