"""Staging puts a bench into the exact state of a cue of a lecture. Earlier commands to it leave no trace."""

from __future__ import annotations

import asyncio

from core.board.board import Board
from scenarios.lecture import State
from scenarios.run import build
from server.bench.benches import Benches
from server.bench.engine import Engine
from server.bench.making import usual_scale
from server.bench.session import Session


class Staging:
    """Puts benches into states.

    Parameters
    ----------
    benches : Benches
        Where benches are made.
    engine : Engine
        Advances them.
    """

    def __init__(self, benches: Benches, engine: Engine) -> None:
        self._benches, self._engine = benches, engine

    async def put(
        self, session: Session | None, state: State, pace: float | None, actor: str, text: str
    ) -> tuple[Session, str]:
        """Put a bench into a state; one of other signals is left alone, and a fresh one made. Return its digest, too.

        Parameters
        ----------
        session : Session, optional
            The bench; without one, a fresh one is made.
        state : State
            The state of the cue.
        pace : float, optional
            Device seconds per wall second; the scale of the device by default.
        actor, text : str
            The user, and the text of the log.
        """

        def made() -> Session:
            board = build(state.scenario)
            fresh = self._benches.maker.around(state.scenario, board, pace or usual_scale(board))
            _advance(fresh, board, state.from_tick)
            return fresh

        fresh = await asyncio.to_thread(made)
        start, digest = state.until_tick > state.from_tick, fresh.board.digest()
        if session is not None and session.has_signals_of(fresh.board):
            await self._engine.call(session.become, fresh, actor, text, start)
            return session, digest
        return await self._benches.take_in(fresh, start), digest


def _advance(session: Session, board: Board, tick: int) -> None:
    """Bring an unpublished bench to a tick, and carry out its waiting commands."""
    while board.tick < tick and session.advance(tick - board.tick):
        pass
    board.apply_due()
    session.done_otherwise()
