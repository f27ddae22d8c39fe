"""Lets benches that run for long run each segment of a tick as one function, which another process compiles."""

from __future__ import annotations

import asyncio
import logging
import os
import sys
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor

from core.board.board import Board
from core.board.segments import SharedSegment
from core.compile.segment import Segment, code_of, kept_code_of
from server.bench.benches import Benches
from server.bench.engine import Engine
from server.clock import Clock
from server.computing.computing import Computing

log = logging.getLogger(__name__)

EVERY_S = 2.0
"""Between two looks at the benches."""
SHORT, LONG = 100_000, 1_000_000
"""Ticks of a bench from which it takes code that is kept, and from which it has the rest compiled.

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
        self._unkept: set[Segment] = set()

    async def run(self, clock: Clock, ready: Callable[[], Awaitable[object]]) -> None:
        """Look at the benches again and again, once the kernels are compiled."""
        await ready()
        async for _ in clock.every(EVERY_S):
            await self.look()

    async def look(self) -> None:
        """Let long benches that run fuse, and load the code that they miss."""
        boards = [session.board for session in self._benches.all() if session.is_running]
        for board in boards:
            if isinstance(board, Board) and board.tick >= SHORT:
                if not board.fuses:
                    await self._engine.call(board.fuse)
                for segment in board.unfused:
                    await self._load(segment, is_long=board.tick >= LONG)

    async def _load(self, segment: SharedSegment, is_long: bool) -> None:
        """Load the code of a segment; code that is not kept, or could not be compiled, is looked for once."""
        aside = self._failed if is_long else self._failed | self._unkept
        if segment.steps in aside or segment.address:
            return
        try:
            code = await self._computing.call(compiled_behind if is_long else kept_code_of, segment.steps)
            if code is None:
                self._unkept.add(segment.steps)
                return
            await asyncio.to_thread(segment.load, code)
        except Exception as error:
            self._failed.add(segment.steps)
            log.warning("%d steps could not become one function, and run one by one: %s", len(segment.steps), error)


def compiled_behind(segment: Segment) -> bytes:
    """Return the code of a segment, compiled by a thread that every other thread interrupts at once.

    Niceness gives a bench more of a processor, but lets it wait some milliseconds for it.
    """
    with ThreadPoolExecutor(1, initializer=_give_way) as thread:
        return thread.submit(code_of, segment).result()


def _give_way() -> None:
    if sys.platform == "linux":
        os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))
