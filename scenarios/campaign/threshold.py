"""Thresholds: over the range of one number of a scenario, where a claim begins to hold, and where it ceases to.

The claim is looked at on a grid; between neighbours of which one bears it out and the other does not, the range is
halved. So a claim that turns twice between two points of the grid is not seen to turn there.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import Any, Literal, Self

from pydantic import BaseModel, Field, ValidationError, model_validator

from core.errors import InputError, from_validation, unknown
from core.format import format_short
from core.table import Table
from scenarios.campaign.campaign import Campaign, Found
from scenarios.campaign.campaign import Table as Results
from scenarios.campaign.check import check
from scenarios.campaign.executor import Processes
from scenarios.campaign.outcome import Outcome
from scenarios.campaign.sweep import Sweep
from scenarios.claims import holds
from scenarios.edit import with_values
from scenarios.expectation import Expectation
from scenarios.run import build
from scenarios.schema import Scenario

ROUNDS = 10
"""How often the range between two points of the grid is halved: it is told to a thousandth of their distance."""
MOST_TURNS = 8
"""Places that are told exactly; where there are more, chance decides."""


class Wanted(Table):
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
    def checked(cls, values: dict[str, Any], field: str = "") -> Wanted:
        """Check what somebody wrote.

        Raises
        ------
        InputError
            Naming what is wrong.
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
    low: float = Field(description="It lies between this value and the next")
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
    """Chooses the values to try, round by round, and tells what they showed.

    Parameters
    ----------
    wanted : Wanted
        The range.
    bears_out : callable
        Whether a figure bears the claim out.
    """

    def __init__(self, wanted: Wanted, bears_out: Callable[[float | None], bool]) -> None:
        self._wanted, self._bears_out = wanted, bears_out
        self._tried: dict[float, Tried] = {}
        self.rounds = 0

    def next(self) -> list[float]:
        """Return the values to try now; none when all is told."""
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
        """Return what is known so far."""
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


class Memory:
    """A table of results that lasts as long as its process."""

    def __init__(self) -> None:
        self._rows: dict[str, str] = {}

    def have(self, keys: Sequence[str]) -> set[str]:
        """Return the keys that are in the table."""
        return {key for key in keys if key in self._rows}

    def outcomes(self, keys: Sequence[str]) -> Iterable[tuple[str, str]]:
        """Return what the table has for some keys."""
        return [(key, self._rows[key]) for key in keys if key in self._rows]

    def put(self, found: Found) -> None:
        """Add outcomes."""
        self._rows.update(found)


def claim_of(scenario: Scenario, metric: str) -> Expectation:
    """Return the expectation of a scenario about a metric.

    Raises
    ------
    InputError
        When there is none.
    """
    for entry in scenario.head.expect:
        if entry.metric == metric:
            return entry
    raise unknown("claim", metric, [entry.metric for entry in scenario.head.expect], "metric")


class Search(Campaign):
    """A campaign whose points follow from each other: the grid, then the halves; `kept` is what was found.

    Parameters
    ----------
    scenario : Scenario
        The scenario.
    wanted : Wanted
        The claim and the number.
    table, workers, processes, on_progress
        As for a campaign.

    Raises
    ------
    InputError
        When the scenario has no such claim or no such number, or an end of the range is not allowed.
    """

    def __init__(
        self,
        scenario: Scenario,
        wanted: Wanted,
        table: Results,
        *,
        workers: int = 1,
        processes: Processes | None = None,
        on_progress: Callable[[int, int], None] = lambda _done, _all: None,
    ) -> None:
        entry = claim_of(scenario, wanted.metric)
        for field in ("low", "high"):
            try:
                build(with_values(scenario, {wanted.path: getattr(wanted, field)}))
            except InputError as error:
                raise InputError(f"{wanted.path}: {error.message}", field, error.hint) from None
        self._scenario, self._wanted = scenario, wanted
        self._halving = Halving(wanted, lambda measured: holds(entry, measured))
        self._values = self._halving.next()
        self._earlier = 0
        super().__init__(self._sweep(), table, workers=workers, processes=processes, on_progress=on_progress)
        check(self.sweep)

    @property
    def total(self) -> int:
        """Runs so far, those of this round included."""
        return self._earlier + super().total

    @property
    def done(self) -> int:
        """Runs that are done."""
        return self._earlier + super().done

    @property
    def progress(self) -> float:
        """Share of the rounds that is done, the grid as much as all others together."""
        rounds = self._halving.rounds
        share = super().done / super().total if super().total else 0.0
        return 0.5 * share if rounds == 0 else min(1.0, 0.5 + 0.5 * (rounds - 1 + share) / ROUNDS)

    def run(self) -> bool:
        """Look until all is told; return whether it is."""
        while super().run():
            self._halving.take(self._measured())
            self.kept = json.loads(self._halving.found().model_dump_json())
            self._values = self._halving.next()
            if not self._values:
                return True
            self._earlier += super().total
            self.sweep = self._sweep()
        return False

    def _sweep(self) -> Sweep:
        """Return the runs of a round."""
        seed = self._scenario.spec.seed
        return Sweep(
            {
                "id": "threshold",
                "scenario": self._scenario.document,
                "grid": {self._wanted.path: self._values},
                "seeds": f"{seed}:{seed}",
            }
        )

    def _measured(self) -> list[tuple[float, float | None]]:
        """Return the figures of a round."""
        keys = [self.sweep.key(number) for number in range(len(self.sweep))]
        texts: dict[str, Any] = dict(self._table.outcomes(keys))
        found = []
        for value, key in zip(self._values, keys, strict=True):
            one = Outcome.model_validate_json(texts[key])
            if one.error:
                raise InputError(f"{self._wanted.path} = {format_short(value, '', 4)}: {one.error}", "path")
            found.append((value, one.metrics.get(self._wanted.metric)))
        return found
