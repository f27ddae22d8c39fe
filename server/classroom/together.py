"""Benches that start together: all are paused at tick 0, then all begin between the same two slices of the engine."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

from core.errors import InputError
from server.bench.bench import LiveBench
from server.bench.benches import Benches
from server.bench.commands import Pause, Reset, Start
from server.bench.engine import Engine
from server.errors import ApiError


async def start_together(
    benches: Benches, engine: Engine, sessions: Sequence[LiveBench | None], actor: str
) -> list[str | None]:
    """Bring benches to tick 0 and start all of them at once; return of each why not, if so.

    A bench that is already paused at tick 0 keeps its settings; any other is reset. From the start on, benches of the
    same time scale are at the same tick, within one round of the engine.

    Parameters
    ----------
    benches : Benches
        Where commands are carried out.
    engine : Engine
        Starts all of them between two slices.
    sessions : sequence of LiveBench
        The benches; a missing bench stays out.
    actor : str
        Who starts them.
    """

    async def stand(session: LiveBench | None) -> str | None:
        if session is None:
            return "there is no bench"
        try:
            await benches.command(session, Pause(), actor)
            if session.board.tick > 0:
                await benches.command(session, Reset(), actor)
        except (InputError, ApiError) as error:
            return str(error)
        return None

    why = await asyncio.gather(*map(stand, sessions))

    def start(session: LiveBench | None, before: str | None) -> str | None:
        if session is None or before is not None:
            return before
        try:
            session.execute(Start(), actor)
        except (InputError, ApiError) as error:
            return str(error)
        return None

    return await engine.call(lambda: [start(*pair) for pair in zip(sessions, why, strict=True)])
