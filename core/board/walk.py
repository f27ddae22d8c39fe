"""The table that the loop of a board walks: the rows that run, and the segments whose code is loaded."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from core.board import program, steps
from core.board.segments import SharedSegment, TablePart, joined, parts
from core.board.spec import Spec
from core.board.wiring import Wiring


class Walk:
    """The rows of a wiring that run.

    Parameters
    ----------
    wiring : Wiring
        Of the board.
    compiled : bool
        Run compiled steps; otherwise ``steps`` has the uncompiled ones.
    fuses : bool
        Run each segment as one function, if its code is loaded.
    """

    def __init__(self, wiring: Wiring, *, compiled: bool, fuses: bool = False) -> None:
        self.compiled, self.fuses = compiled, fuses
        self.running: list[int] = []
        self.steps: list[Callable[[], None]] = []
        self.table = self._rows = wiring.table
        self.idle = np.zeros(0, np.bool_)
        self.awaited: list[SharedSegment] = []
        self._linked: Wiring | None = None
        self._addresses: dict[int, int] = {}
        self.parts: list[TablePart] = []

    def link(self, wiring: Wiring, spec: Spec) -> None:
        """Put the addresses of the compiled steps into the table, and leave out rows that rest."""
        if wiring is self._linked and not wiring.is_changed:
            return
        running = wiring.rest(spec)
        if wiring is self._linked and running == self.running:
            self._rows[:, program.EVERY] = wiring.table[running, program.EVERY]
        else:
            if wiring is not self._linked:
                self._addresses = {}
            self._linked, self.running = wiring, running
            self._rows = wiring.table[running]
            self.idle = wiring.idle(running)
            if self.compiled:
                self._rows[:, program.ADDRESS] = [self._address(wiring, row) for row in running]
            else:
                self.steps = [wiring.bound(row) for row in running]
        self._find_parts(wiring)

    def _address(self, wiring: Wiring, row: int) -> int:
        if row not in self._addresses:
            self._addresses[row] = steps.address(wiring, row)
        return self._addresses[row]

    def fuse(self, wiring: Wiring) -> None:
        """Run each segment as one function from now on, if its code is loaded."""
        self.fuses = self.compiled
        self._find_parts(wiring)

    def join(self) -> None:
        """Put the code of segments that was loaded since into the table."""
        if any(segment.address for segment in self.awaited):
            self._join()

    def forget(self) -> None:
        """Take all addresses anew with the next link."""
        self._linked = None

    def _find_parts(self, wiring: Wiring) -> None:
        self.parts = parts(wiring, self.running) if self.fuses else []
        self._join()

    def _join(self) -> None:
        self.table = joined(self._rows, self.parts) if self.parts else self._rows
        self.awaited = [part.segment for part in self.parts if part.segment and not part.segment.address]
