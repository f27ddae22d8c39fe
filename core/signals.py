"""The names, units and places of all signals of a board."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Literal

from pydantic import BaseModel

from core.errors import unknown

CLOCK = ("tick", "time_ms")
"""Columns of every trace that are not signals."""


class Signal(BaseModel):
    """One traced signal.

    ``kind`` is ``output`` (part of the digest) or ``tap`` (an inner signal worth seeing); ``index`` is its
    column in the trace, outputs first.
    """

    name: str
    unit: str
    meaning: str
    block: str
    kind: Literal["output", "tap"]
    index: int


class SignalTable(Sequence[Signal]):
    """All traced signals of a board, outputs before taps."""

    def __init__(self, signals: Sequence[Signal]) -> None:
        self._signals = tuple(signals)
        self._by_name = {signal.name: signal for signal in signals}
        self.outputs = sum(signal.kind == "output" for signal in signals)

    def __len__(self) -> int:
        return len(self._signals)

    def __getitem__(self, index: int) -> Signal:  # type: ignore[override]
        return self._signals[index]

    def __iter__(self) -> Iterator[Signal]:
        return iter(self._signals)

    def __contains__(self, name: object) -> bool:
        return name in self._by_name

    @property
    def names(self) -> list[str]:
        """Names in trace order."""
        return [signal.name for signal in self._signals]

    @property
    def taps(self) -> Sequence[Signal]:
        """Traced signals that follow the outputs."""
        return self._signals[self.outputs :]

    @cached_property
    def output_blocks(self) -> list[str]:
        """The block of each output."""
        return [signal.block for signal in self._signals[: self.outputs]]

    def index(self, name: str) -> int:  # type: ignore[override]
        """Return the trace column of ``name``.

        Raises
        ------
        InputError
            When there is no such signal.
        """
        try:
            return self._by_name[name].index
        except (KeyError, TypeError):
            raise unknown("signal", name, self.names, "signals") from None
