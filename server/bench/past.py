"""The past of a bench: what it takes to compute a moment of it again, away from the engine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from core.board.board import Board
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
    scenario : Scenario
        The scenario of the bench.
    passage : Passage
        The way to the moment, from so many ticks before that the panels have something to show.
    track : Track
        The track of the bench, not followed any further.
    events : list of Event
        What has happened on the bench, also after the moment.
    told : Told
        What the narrator had said where the way begins.
    time_scale : float or None
        Its pace.
    origin : Origin
        The bench and the tick.
    is_before : bool
        What was done at that very tick is left out.
    """

    scenario: Scenario
    passage: Passage
    track: Track
    events: list[Event]
    told: Told
    time_scale: float | None
    origin: Origin
    is_before: bool = False

    @classmethod
    def of(cls, session: Session, tick: int, window_ticks: int, *, is_before: bool = False) -> Past:
        """Take what is needed of a bench (a job of the engine).

        Parameters
        ----------
        session : Session
            The bench.
        tick : int
            The moment, with all that was done at that tick unless it is before it.
        window_ticks : int
            Ticks before the moment that are computed too.
        is_before : bool
            Leave out what was done at that very tick.

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
        passage = track.to(tick, window_ticks, is_before=is_before)
        return cls(
            scenario=session.scenario,
            passage=passage,
            track=track.copy(),
            events=session.events.after(0)[1],
            told=session.narration.told_at(passage.checkpoint.tick),
            time_scale=session.pacer.scale,
            origin=Origin(bench=session.id, tick=tick, window_ticks=window_ticks),
            is_before=is_before,
        )

    def session(self, maker: Maker, on_share: Callable[[float], None]) -> Session:
        """Compute the moment again, and return a bench that is there and can go on.

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
        for rows in self.passage.walk(board):
            session.history.append(rows)
            session.narration.follow(board.log, rows)
            on_share(1.0 - (self.passage.tick - board.tick) / self.passage.ticks)
        session.narration.follow(board.log)
        board.log = Log()  # the log of the bench has it all
        session.events.go_on(self.events)
        session.taken_over = session.events.last
        session.track = self.track.until(board)
        session.origin = self.origin
        session.look_back("api", is_before=self.is_before)
        session.refresh_status()
        return session
