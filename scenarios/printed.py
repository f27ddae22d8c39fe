"""A printed mark: a number that the dissertation gives for a figure, as a band, a value or a moment of a signal."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field, model_validator

from core.board.commands import LONGEST_MS
from core.format import format_short
from core.table import Table, Words

Kind = Literal["band", "value", "moment"]


class Printed(Table):
    """A number of the text about a figure, drawn over a signal in time.

    It is one of three: a band from ``low`` to ``high``, lines at ``values``, or a moment ``at_sample`` or ``at_ms``.
    Times count from an event of the scenario, or from its start. Every number that is drawn is in ``words``, which are
    quoted; where a number follows from them or is chosen by us, ``reading`` explains it.
    """

    figure: str = Field("", max_length=40, description="number of the figure; empty for a sentence without one")
    section: str = Field(min_length=1, max_length=40, description="number of the section")
    words: Words = Field(min_length=1, max_length=300, description="as printed")
    number: Words = Field(min_length=1, max_length=40, description="the part of the words that is the number")
    signal: str = Field(min_length=1, max_length=200, description="the signal it is drawn over")
    unit: str = Field(max_length=20, description="of the numbers here, the unit of the signal")
    low: float | None = Field(None, description="lower end of a band, in the unit")
    high: float | None = Field(None, description="upper end of a band, in the unit")
    values: list[float] = Field([], max_length=8, description="lines, in the unit")
    at_sample: int | None = Field(None, ge=0, description="sample of a moment")
    at_ms: float | None = Field(None, ge=0, le=LONGEST_MS, description="device time of a moment, ms")
    event: int | None = Field(None, ge=0, description="position of the event that times count from")
    after_ms: float = Field(0.0, ge=0, le=LONGEST_MS, description="where a band or a value begins, ms")
    until_ms: float | None = Field(None, gt=0, le=LONGEST_MS, description="where it ends; at the end of the run, ms")
    metric: str = Field("", max_length=200, description="the expectation that judges it")
    reading: Words = Field("", max_length=500, description="where a number comes from that is not in the words")

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        if (self.low is None) != (self.high is None):
            raise ValueError("low and high go together")
        said = [self.low is not None, bool(self.values), self.at_sample is not None, self.at_ms is not None]
        if sum(said) != 1:
            raise ValueError("needs one of low with high, values, at_sample and at_ms")
        if self.low is not None and self.high is not None and self.low >= self.high:
            raise ValueError(f"needs low < high, got {self.low:g} and {self.high:g}")
        if self.kind == "moment" and (self.after_ms or self.until_ms is not None):
            raise ValueError("a moment has no after_ms and no until_ms")
        if self.until_ms is not None and self.until_ms <= self.after_ms:
            raise ValueError("needs after_ms < until_ms")
        return self

    @model_validator(mode="after")
    def _is_quoted(self) -> Self:
        if self.number not in self.words:
            raise ValueError(f"number {self.number!r} is not in the words")
        missing = [text for text in map(written, self.drawn) if text not in self.words]
        if missing and not self.reading:
            raise ValueError(f"{missing[0]} is drawn and not in the words: reading says where it comes from")
        return self

    @property
    def kind(self) -> Kind:
        """The shape of its drawing."""
        if self.low is not None:
            return "band"
        return "value" if self.values else "moment"

    @property
    def drawn(self) -> list[float]:
        """The numbers that are drawn."""
        ends = [end for end in (self.low, self.high, self.at_sample, self.at_ms) if end is not None]
        return [*ends, *self.values]

    def ticks(self, since: int, dt_ms: float) -> tuple[int, int | None]:
        """Return the first and the last tick it is drawn at; None for the end of the run.

        Parameters
        ----------
        since : int
            Tick of its event.
        dt_ms : float
            Sample interval, ms.
        """
        if self.kind == "moment":
            at = self.at_sample if self.at_sample is not None else round((self.at_ms or 0.0) / dt_ms)
            return since + at, since + at
        first = since + round(self.after_ms / dt_ms)
        return first, None if self.until_ms is None else since + round(self.until_ms / dt_ms)


def written(value: float) -> str:
    """Write a number as texts do, without its sign."""
    return format_short(abs(value), "", 6)
