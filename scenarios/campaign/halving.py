"""Halving: over the range of a number, the places where a claim begins to hold and where it ceases to.

The claim is tried at the points of a grid. Where it holds at one point and not at the next, the range between them is
halved. A claim that turns twice between two points of the grid is not seen to turn there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import Any, Literal, Self

from pydantic import BaseModel, Field, ValidationError, model_validator

from core.errors import InputError, from_validation
from core.format import format_short
from core.table import Table

ROUNDS = 10
"""Halvings of the range between two points of the grid: the threshold is found to a thousandth of it."""
MOST_TURNS = 8
"""Number of thresholds that are found exactly; where there are more, the result depends on chance."""


class ThresholdGoal(Table):
    """The claim and the number that are looked at."""

    metric: str = Field(min_length=1, max_length=200)
    path: str = Field(min_length=1, max_length=200)
    low: float
    high: float
    scale: Literal["linear", "log"] = "linear"
    points: int = Field(17, ge=3, le=65, description="Of the grid, both ends included")

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if self.low >= self.high:
            raise ValueError("needs low < high")
        if self.scale == "log" and self.low <= 0:
            raise ValueError("needs low > 0 for a logarithmic scale")
        return self

    @classmethod
    def checked(cls, values: dict[str, Any], field: str = "") -> ThresholdGoal:
        """Check the request of a user.

        Raises
        ------
        InputError
            Naming the error.
        """
        try:
            return cls.model_validate(values)
        except ValidationError as error:
            refused = from_validation(error)
            raise InputError(refused.message, field or refused.field, refused.hint) from None

    def grid(self) -> list[float]:
        """Return the points that are looked at first."""
        return [self._at(position / (self.points - 1)) for position in range(self.points)]

    def middle(self, low: float, high: float) -> float:
        """Return the point half way between two."""
        return math.sqrt(low * high) if self.scale == "log" else 0.5 * (low + high)

    def _at(self, share: float) -> float:
        if share in (0.0, 1.0):
            return self.high if share else self.low
        if self.scale == "log":
            return self.low * math.exp(math.log(self.high / self.low) * share)
        return self.low + (self.high - self.low) * share


class Tried(BaseModel):
    """A value that was tried, the figure measured with it, and whether the claim holds there."""

    value: float
    measured: float | None
    holds: bool


class ThresholdTurn(BaseModel):
    """A place where a claim begins to hold, or ceases to, as the number grows."""

    value: float = Field(description="The value nearest to it at which the claim holds")
    begins: bool
    low: float = Field(description="It is between this value and the next")
    high: float


class Threshold(BaseModel):
    """Where a claim holds over the range of a number."""

    metric: str
    path: str
    low: float
    high: float
    scale: Literal["linear", "log"]
    tried: list[Tried] = Field(description="By rising value")
    turns: list[ThresholdTurn]
    words: str


class Halving:
    """Chooses the values to try, round by round, and reports their results.

    Parameters
    ----------
    wanted : Wanted
        The range.
    bears_out : callable
        Whether the claim holds for a figure.
    """

    def __init__(self, wanted: ThresholdGoal, bears_out: Callable[[float | None], bool]) -> None:
        self._wanted, self._bears_out = wanted, bears_out
        self._tried: dict[float, Tried] = {}
        self.rounds = 0

    def next(self) -> list[float]:
        """Return the values to try now; empty at the end."""
        if not self._tried:
            return self._wanted.grid()
        if self.rounds > ROUNDS:
            return []
        middles = (self._wanted.middle(one.value, other.value) for one, other in self._turning()[:MOST_TURNS])
        return [value for value in middles if value not in self._tried]

    def take(self, measured: Iterable[tuple[float, float | None]]) -> None:
        """Take the figures of a round."""
        self.rounds += 1
        for value, figure in measured:
            self._tried[value] = Tried(value=value, measured=figure, holds=self._bears_out(figure))

    def found(self) -> Threshold:
        """Return the result so far."""
        wanted = self._wanted
        turns = [
            ThresholdTurn(
                value=other.value if other.holds else one.value, begins=other.holds, low=one.value, high=other.value
            )
            for one, other in self._turning()
        ]
        return Threshold(
            **wanted.model_dump(exclude={"points"}), tried=self._sorted(), turns=turns, words=self._words(turns)
        )

    def _sorted(self) -> list[Tried]:
        return sorted(self._tried.values(), key=lambda one: one.value)

    def _turning(self) -> list[tuple[Tried, Tried]]:
        return [(one, other) for one, other in pairwise(self._sorted()) if one.holds != other.holds]

    def _words(self, turns: Sequence[ThresholdTurn]) -> str:
        """Say where it holds."""
        low, high = (format_short(end, "", 4) for end in (self._wanted.low, self._wanted.high))
        if not turns:
            where = "everywhere" if self._sorted()[0].holds else "nowhere"
            return f"holds {where} from {low} to {high}"
        begin: str | None = None if turns[0].begins else low
        parts: list[str] = []
        for turn in turns:
            value = format_short(turn.value, "", 4)
            if turn.begins:
                begin = value
            else:
                parts.append(f"up to {value}" if begin == low and not parts else f"from {begin} to {value}")
                begin = None
        if begin is not None:
            parts.append(f"from {begin} on")
        return "holds " + ", and ".join(parts)
