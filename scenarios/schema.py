"""A scenario: a bench, its events, and its expectations."""

from __future__ import annotations

from typing import Any, Literal, Self

import tomlkit
from pydantic import Field, ValidationError, model_validator

from core.board.commands import LONGEST_MS, Command, parse_event
from core.board.document import Document
from core.board.ensemble import twin_specs
from core.board.parse import parse
from core.board.spec import fields
from core.errors import InputError, from_validation, unknown_field
from core.format import format_short
from core.nesting import read_toml
from core.table import Table
from scenarios.measure.stretch import Stretch
from scenarios.studies import parse_study

Verdict = Literal["reproduced", "reproduced by tuning", "partly", "not reproduced"]
MAX_SAMPLES = 200_000_000


class Expectation(Table):
    """What a metric should be, and what was published."""

    metric: str
    min: float | None = None
    max: float | None = None
    value: float | None = None
    tolerance: float | None = Field(None, ge=0)
    published: str = ""
    published_value: float | None = None
    published_range: tuple[float, float] | None = None
    fitted: list[str] = []
    compare: Literal["open_loop", "pid", "none"] | None = None
    reason: str = ""
    verdict: Verdict | None = None
    note: str = ""

    @model_validator(mode="after")
    def _bounded(self) -> Self:
        if (self.value is None) != (self.tolerance is None):
            raise ValueError("value and tolerance go together")
        if self.value is None and self.min is None and self.max is None:
            raise ValueError("needs min, max, or value with tolerance")
        if self.min is not None and self.max is not None and self.min > self.max:
            raise ValueError(f"can never hold: min {self.min:g} is more than max {self.max:g}")
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
        """Write the expectation as text."""
        if self.value is not None:
            return f"{format_short(self.value, '', 6)} ± {format_short(self.tolerance or 0.0, '', 6)}"
        parts = [f">= {format_short(self.min, '', 6)}"] if self.min is not None else []
        parts += [f"<= {format_short(self.max, '', 6)}"] if self.max is not None else []
        return " and ".join(parts)


class Head(Table):
    """All of a scenario that is not the bench itself."""

    schema_: Literal[1] = Field(1, alias="schema")
    id: str = Field("unnamed", pattern=r"^[A-Za-z0-9][A-Za-z0-9-]{0,63}$")
    title: str = Field("", max_length=200)
    source: str = Field("", max_length=500)
    summary: str = Field("", max_length=2000)
    claim: str = Field("", max_length=2000)
    verdict: Verdict | None = None
    samples: int | None = Field(None, ge=1, le=MAX_SAMPLES)
    duration_ms: float | None = Field(None, gt=0, le=LONGEST_MS)
    events: list[dict[str, Any]] = Field([], max_length=100_000)
    expect: list[Expectation] = Field([], max_length=1000)
    metrics: Stretch = Stretch()
    study: dict[str, Any] | None = None


HEAD = tuple("schema" if name == "schema_" else name for name in Head.model_fields)


class Scenario:
    """A checked scenario.

    Attributes
    ----------
    document : dict
        The document it was read from.
    head : Head
        Title, length, events, expectations.
    bench : dict
        The part of the document that describes the bench.
    spec : Spec
        The checked bench; every board of the scenario is built from it.
    twins : dict of Spec
        The bench of every twin, checked.
    study : tuple, optional
        The study to make of the bench instead of a run, and its parameters.
    events : list of list of Command
        The commands of every event, in the order they take effect.
    """

    def __init__(self, document: Document) -> None:
        if not isinstance(document, dict):
            raise InputError("a scenario must be a table", "scenario")
        self.document = document
        head = {key: value for key, value in document.items() if key in HEAD}
        self.bench: Document = {key: value for key, value in document.items() if key not in HEAD}
        try:
            self.head = Head.model_validate(head)
        except ValidationError as error:
            raise from_validation(error, {"": (*HEAD, *fields()), "metrics": [*Stretch.model_fields]}) from None
        if self.head.samples is not None and self.head.duration_ms is not None:
            raise InputError("give samples or duration_ms, not both", "duration_ms")
        unknown = [key for key in self.bench if key not in fields()]
        if unknown:
            raise unknown_field(unknown[0], (*HEAD, *fields()), unknown[0])
        self.spec = parse(self.bench)
        if (self.samples or 0) > MAX_SAMPLES:
            raise InputError(f"is {self.samples} samples, at most {MAX_SAMPLES}", "duration_ms")
        self.twins = twin_specs(self.bench)
        self.study = parse_study(self.head.study) if self.head.study is not None else None
        self.events: list[list[Command]] = []
        for position, event in enumerate(self.head.events):
            try:
                self.events.append(_commands(event))
            except InputError as error:
                raise error.under(f"events.{position}") from None

    @classmethod
    def load(cls, text: str | Document) -> Scenario:
        """Read a scenario from TOML or from a document.

        Raises
        ------
        InputError
            Naming the field, or the line of malformed TOML.
        """
        return cls(text if isinstance(text, dict) else read_toml(text, "scenario"))

    @property
    def id(self) -> str:
        """Library id."""
        return self.head.id

    @property
    def samples(self) -> int | None:
        """Length in ticks, or None if it has no end."""
        if self.head.duration_ms is not None:
            return max(1, round(self.head.duration_ms / self.spec.dt_ms))
        return self.head.samples

    def toml(self) -> str:
        """Return the scenario as TOML."""
        return tomlkit.dumps(self.document)


def _commands(event: Document) -> list[Command]:
    """Return the commands of an event; unlike what is done by hand it must say when."""
    commands = parse_event(event)
    if all(moment is None for moment in (commands[0].at_sample, commands[0].at_ms, commands[0].when)):
        raise InputError("needs one of at_sample, at_ms, when")
    return commands
