"""An expectation: the expected figure, the published figure, and the word that follows from both."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Annotated, Literal, Self, get_args

from pydantic import Field, WithJsonSchema, model_validator

from core.format import format_short, format_within
from core.table import Table, Words
from scenarios.metric_name import metric_unit

Verdict = Literal[
    "reproduced",
    "reproduced by tuning",
    "reproduced, by a PID too",
    "reproduced by tuning, by a PID too",
    "partly",
    "not reproduced",
    "ours",
]
VERDICTS: tuple[Verdict, ...] = get_args(Verdict)
AGREES = 0.05
"""Share of a published number within which a figure agrees with it, where no range is given."""
LESS = ("error_um", "error_nm", "settling_ms")
"""Ends of the metrics where less is always better."""
End = Annotated[
    float, Field(allow_inf_nan=True), WithJsonSchema({"anyOf": [{"type": "number"}, {"enum": ["inf", "-inf"]}]})
]
"""An end of a range; JSON has an open end as a text."""


class Expectation(Table):
    """The expected and the published value of a metric.

    ``published`` are the words of the text, ``published_value`` its number. A figure agrees with the text when it is in
    ``published_range``, ends included; without a range, within 5 % of ``published_value``. ``fitted`` are the fields of
    the scenario that were chosen so that it agrees. ``compare`` names the case that must miss the expectation by
    `margin` for it to praise a controller: the open loop, or none, for a ``reason``. With ``"pid"`` the comparator of
    the scenario is compared too, and ``pid_too`` says that this PID `does_as_well`. ``verdict`` is not read: earlier
    files have one.
    """

    metric: str = Field(description="name of the figure, such as control.rms_error_um")
    min: float | None = Field(None, description="smallest expected value, in the unit of the metric")
    max: float | None = Field(None, description="largest expected value, in the unit of the metric")
    value: float | None = Field(None, description="expected value, in the unit of the metric; goes with tolerance")
    tolerance: float | None = Field(None, ge=0, description="largest distance from value")
    published: Words = Field("", description="words of the text")
    published_value: float | None = Field(None, description="number of the text, in the unit of the metric")
    published_range: tuple[End, End] | None = Field(None, description="values that agree with the text, ends included")
    fitted: list[str] = Field([], description="fields of the scenario that were chosen so that it agrees")
    compare: Literal["open_loop", "pid", "none"] | None = Field(
        None, description="the case that must miss it, for it to praise a controller"
    )
    pid_too: bool = Field(False, description="whether a PID does as well")
    reason: Words = Field("", description='why nothing is compared, with compare = "none"')
    verdict: str | None = Field(None, description="not read: it follows from the published figures")
    note: Words = Field("", description="origin of the figures")

    @model_validator(mode="after")
    def _bounded(self) -> Self:
        if (self.value is None) != (self.tolerance is None):
            raise ValueError("value and tolerance go together")
        if self.value is None and self.min is None and self.max is None:
            raise ValueError("needs min, max, or value with tolerance")
        if self.min is not None and self.max is not None and self.min > self.max:
            raise ValueError(f"can never hold: min {self.min:g} is more than max {self.max:g}")
        return self

    @model_validator(mode="after")
    def _comparable(self) -> Self:
        low, high = self.published_range or (-math.inf, math.inf)
        if not low <= high:
            raise ValueError(f"published_range must be [low, high] with low <= high, got [{low:g}, {high:g}]")
        if self.published_value == 0.0 and self.published_range is None:
            raise ValueError("published_value 0 needs published_range: 5 % of it is nothing")
        if self.published_value is not None and not low <= self.published_value <= high:
            raise ValueError(f"published_value {self.published_value:g} is outside published_range")
        if self.fitted and self.agreeing is None:
            raise ValueError("fitted goes with published_value or published_range")
        if (self.compare == "none") != bool(self.reason):
            raise ValueError('compare = "none" and reason go together')
        if self.pid_too and self.compare != "pid":
            raise ValueError('pid_too goes with compare = "pid"')
        return self

    def holds(self, measured: float | None) -> bool:
        """Return whether a measured value is as expected."""
        if measured is None:
            return False
        low, high = self.bounds()
        return (low is None or measured >= low) and (high is None or measured <= high)

    def bounds(self) -> tuple[float | None, float | None]:
        """Return the smallest and the largest value that count as expected."""
        if self.value is None:
            return self.min, self.max
        return self.value - (self.tolerance or 0.0), self.value + (self.tolerance or 0.0)

    def text(self) -> str:
        """Write the expectation for programs: plain characters, in the unit of its metric."""
        if self.value is not None:
            return f"{format_short(self.value, '', 6)} ± {format_short(self.tolerance or 0.0, '', 6)}"
        parts = [f">= {format_short(self.min, '', 6)}"] if self.min is not None else []
        parts += [f"<= {format_short(self.max, '', 6)}"] if self.max is not None else []
        return " and ".join(parts)

    def words(self) -> str:
        """Write the expectation for readers: with a unit and its prefix."""
        unit = metric_unit(self.metric)
        if self.value is not None:
            return format_within(self.value, self.tolerance or 0.0, unit)
        parts = [f"≥\u00a0{format_short(self.min, unit, 6)}"] if self.min is not None else []
        parts += [f"≤\u00a0{format_short(self.max, unit, 6)}"] if self.max is not None else []
        return " and ".join(parts)

    @property
    def margin(self) -> float:
        """How far outside its bounds a figure misses by twice the tolerance.

        The tolerance is half the width of the bounds. With one bound it is the distance to the best possible value: the
        bound itself above 0, for a share the difference to 1, else half the bound.
        """
        low, high = self.bounds()
        if low is not None and high is not None:
            return (high - low) / 2.0
        if high is not None:
            return abs(high)
        assert low is not None
        return 1.0 - low if self.metric.endswith("fraction") else abs(low) / 2.0

    def missed_twice(self, measured: float | None) -> bool:
        """Return whether a figure misses the expectation by twice its tolerance, or is not there at all."""
        low, high = self.bounds()
        if measured is None:
            return True
        below = low is not None and measured < low and low - measured >= self.margin * (1 - 1e-9)
        above = high is not None and measured > high and measured - high >= self.margin * (1 - 1e-9)
        return below or above

    def does_as_well(self, pid: float | None) -> bool:
        """Return whether the figure of a PID agrees with the text, or does not miss the expectation by `margin`.

        An error or a time that is less than expected is no miss.
        """
        if pid is None:
            return False
        low, high = self.agreeing or (math.inf, -math.inf)
        _, most = self.bounds()
        is_less = self.metric.endswith(LESS) and most is not None and pid <= most
        return is_less or low <= pid <= high or not self.missed_twice(pid)

    @property
    def agreeing(self) -> tuple[float, float] | None:
        """The range in which a figure agrees with the text, or None where the text has nothing to compare with."""
        if self.published_range is not None or self.published_value is None:
            return self.published_range
        width = AGREES * abs(self.published_value)
        return self.published_value - width, self.published_value + width

    def word(self, measured: float | None, pid: float | None = None) -> Verdict | None:
        """Return the word for a measured figure, None where words were published that nothing compares it with.

        Parameters
        ----------
        measured : float, optional
            The figure.
        pid : float, optional
            Figure of the comparator; without it ``pid_too`` holds.
        """
        if self.agreeing is None:
            return None if self.published else "ours"
        low, high = self.agreeing
        return self._agreed(measured is not None and low <= measured <= high, self._pid_too(pid))

    def promised(self) -> Verdict | None:
        """Return the word if the expectation holds, which is all there is before a run."""
        if self.agreeing is None:
            return self.word(None)
        low, high = self.bounds()
        below = high is not None and high < self.agreeing[0]
        above = low is not None and low > self.agreeing[1]
        return self._agreed(not below and not above, self.pid_too)

    def _pid_too(self, pid: float | None) -> bool:
        return self.pid_too if pid is None or self.compare != "pid" else self.does_as_well(pid)

    def _agreed(self, agrees: bool, pid_too: bool) -> Verdict:
        return _agreement(bool(self.fitted), pid_too) if agrees else "not reproduced"


def overall(words: Iterable[Verdict | None]) -> Verdict | None:
    """Return the word for a scenario from the words of its rows; None where no row has a word.

    Rows that the dissertation does not claim do not count if other rows are claimed. If all the rest agrees, the
    scenario is reproduced, by tuning where one row is, by a PID too where one row is; if nothing agrees it is not; else
    partly.
    """
    found = {word for word in words if word is not None}
    claimed = found - {"ours"}
    if not claimed:
        return "ours" if found else None
    if "not reproduced" not in claimed and "partly" not in claimed:
        return _agreement(any("tuning" in word for word in claimed), any("PID" in word for word in claimed))
    return "not reproduced" if claimed == {"not reproduced"} else "partly"


def _agreement(by_tuning: bool, pid_too: bool) -> Verdict:
    if pid_too:
        return "reproduced by tuning, by a PID too" if by_tuning else "reproduced, by a PID too"
    return "reproduced by tuning" if by_tuning else "reproduced"
