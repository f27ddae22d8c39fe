"""Lets benches that run for long run each segment of a tick as one function, which another process compiles."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable

from core.board.board import Board
from core.board.segments import SharedSegment
from core.compile.segment import Segment, code_of
from server.bench.benches import Benches
from server.bench.engine import Engine
from server.clock import Clock
from server.computing.computing import Computing

log = logging.getLogger(__name__)

EVERY_S = 2.0
"""Between two looks at the benches."""
LONG = 1_000_000
"""Ticks of a bench that is worth it.

To compile a segment takes about 3 s of a processor, and its code saves about 0.1 us a tick. The code is kept for every
other bench with the same blocks, and for the next start.
"""


class Fusing:
    """Finds segments whose code is not loaded, and loads it; the benches take it at a tick edge.

    Parameters
    ----------
    benches : Benches
        The benches.
    engine : Engine
        Whose thread may change a board.
    computing : Computing
        Where segments are compiled: in this process that would make running benches wait for the interpreter.
    """

    def __init__(self, benches: Benches, engine: Engine, computing: Computing) -> None:
        self._benches, self._engine, self._computing = benches, engine, computing
        self._failed: set[Segment] = set()

    async def run(self, clock: Clock, ready: Callable[[], Awaitable[object]]) -> None:
        """Look at the benches again and again, once the kernels are compiled."""
        await ready()
        async for _ in clock.every(EVERY_S):
            await self.look()

    async def look(self) -> None:
        """Let long benches that run fuse, and load the code that they miss."""
        boards = [session.board for session in self._benches.all() if session.is_running]
        for board in boards:
            if isinstance(board, Board) and board.tick >= LONG:
                if not board.fuses:
                    await self._engine.call(board.fuse)
                for segment in board.unfused:
                    await self._load(segment)

    async def _load(self, segment: SharedSegment) -> None:
        """Load the code of a segment; after a failure it is not tried again."""
        if segment.steps in self._failed or segment.address:
            return
        try:
            code = await self._computing.call(code_of, segment.steps)
            await asyncio.to_thread(segment.load, code)
        except Exception as error:
            self._failed.add(segment.steps)
            log.warning("%d steps could not become one function, and run one by one: %s", len(segment.steps), error)
