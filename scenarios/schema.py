"""A scenario: a bench, its events, and its expectations."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from functools import cached_property
from typing import Any, Literal

from pydantic import Field, ValidationError

from core.board import supervision
from core.board.changes import check
from core.board.commands import LONGEST_MS, Command, Switch, parse_event
from core.board.condition import parse_condition
from core.board.document import Document, has, says_the_same
from core.board.ensemble import twin_specs
from core.board.packages import carried
from core.board.parse import changed, parse
from core.board.spec import Spec, fields
from core.board.wiring import signals_of
from core.errors import InputError, from_validation, short, unknown, unknown_field
from core.nesting import read_toml
from core.own.admission import check_admitted
from core.own.apart import compile_by
from core.table import Table, Words
from scenarios.comparator import NONE, Comparator
from scenarios.expectation import Expectation, Verdict, overall
from scenarios.measure.stretch import Stretch
from scenarios.own import compile_apart
from scenarios.printed import Printed
from scenarios.reading import schema_line, without_address
from scenarios.studies import parse_study

MAX_SAMPLES = 200_000_000
MOST_EVENTS = 100_000
compile_by(compile_apart)
UNREAD = "verdict is not read: it follows from published_value, published_range and fitted"


class ScenarioHead(Table):
    """All of a scenario that is not the bench itself; ``verdict`` is not read, earlier files have one."""

    schema_: Literal[1] = Field(1, alias="schema", description="version of the notation")
    id: str = Field("unnamed", pattern=r"^[A-Za-z0-9][A-Za-z0-9-]{0,63}$", description="short name")
    title: Words = Field("", max_length=200, description="title for people")
    source: Words = Field("", max_length=500, description="where it comes from: sections, figures, equations")
    summary: Words = Field("", max_length=2000, description="what it shows, in a few sentences")
    claim: Words = Field("", max_length=2000, description="the published claim")
    verdict: str | None = Field(None, description="not read: it follows from the expectations")
    samples: int | None = Field(None, ge=1, le=MAX_SAMPLES, description="length of a run, in samples")
    duration_ms: float | None = Field(None, gt=0, le=LONGEST_MS, description="length of a run in its place, ms")
    events: list[dict[str, Any]] = Field([], max_length=MOST_EVENTS, description="commands, each at its moment")
    expect: list[Expectation] = Field([], max_length=1000, description="expected and published figures of a run")
    comparator: Comparator | None = Field(None, description="the PID that claims for a controller are compared with")
    printed: list[Printed] = Field([], max_length=200, description="printed numbers, drawn over the signals of a run")
    metrics: Stretch = Field(Stretch(), description="the part of a run that its figures are computed from")
    study: dict[str, Any] | None = Field(None, description="a computation in place of a run")

    def compared_with(self, entry: Expectation) -> str:
        """Name the PID that an expectation is compared with; nothing where it is compared with none."""
        if entry.compare != "pid":
            return ""
        return self.comparator.name if self.comparator is not None else NONE


HEAD = tuple("schema" if name == "schema_" else name for name in ScenarioHead.model_fields)


class Scenario:
    """A checked scenario.

    Attributes
    ----------
    head : Head
        Title, length, events, expectations.
    spec : Spec
        The checked bench; every board of the scenario is built from it.
    twins : dict of Spec
        The bench of every twin, checked.
    study : tuple, optional
        The study to make of the bench instead of a run, and its parameters.
    events : list of list of Command
        The commands of every event, in the order they take effect.
    """

    _write: Callable[[], Document]

    def __init__(self, document: Document, like: Scenario | None = None) -> None:
        if not isinstance(document, dict):
            raise InputError("a scenario must be a table", "scenario")
        check_admitted(document)
        self.document = document = carried(_with_open_ends(without_address(document)))
        head = {key: value for key, value in document.items() if key in HEAD}
        self._head, known = head, like._head if like is not None else {}
        is_alike = head.keys() == known.keys() and all(says_the_same(value, known[key]) for key, value in head.items())
        try:
            self.head: ScenarioHead = like.head if like is not None and is_alike else ScenarioHead.model_validate(head)
        except ValidationError as error:
            raise from_validation(error, {"": (*HEAD, *fields()), "metrics": [*Stretch.model_fields]}) from None
        if self.head.samples is not None and self.head.duration_ms is not None:
            raise InputError("give samples or duration_ms, not both", "duration_ms")
        allowed = fields()
        foreign = [key for key in self.bench if key not in allowed]
        if foreign:
            raise unknown_field(foreign[0], (*HEAD, *allowed), foreign[0])
        self.spec: Spec = parse(self.bench, like.spec if like is not None else None)
        self._check_length()
        if (beside := self.head.metrics.beside) and beside not in self.spec.diagnosers:
            raise unknown("diagnoser", beside, self.spec.diagnosers, "metrics.beside")
        supervision.check(self.spec)
        self.twins = twin_specs(self.bench)
        self.study = parse_study(self.head.study) if self.head.study is not None else None
        self.events: list[list[Command]] = like.events if like is not None and is_alike else []
        for position, event in enumerate([] if is_alike else self.head.events):
            try:
                self.events.append(self._checked(event))
            except InputError as error:
                raise error.under(f"events.{position}") from None
        for position, entry in enumerate(self.head.expect):
            for path in entry.fitted:
                if not has(document, path):
                    raise InputError(f"this scenario has no {short(path)}", f"expect.{position}.fitted")

    def _check_length(self) -> None:
        if (self.samples or 0) > MAX_SAMPLES:
            raise InputError(f"is {self.samples} samples, at most {MAX_SAMPLES}", "duration_ms")
        if self.spec.record is not None and (self.samples or 0) > self.spec.record.samples:
            field = "samples" if self.head.samples is not None else "duration_ms"
            raise InputError(f"is {self.samples} samples, the record has {self.spec.record.samples}", field)

    @property
    def asks_estimates(self) -> bool:
        """Whether figures of weighted estimates are asked for: by an option, or by an expectation."""
        return self.head.metrics.estimation or any(one.metric.startswith("estimation.") for one in self.head.expect)

    def _checked(self, event: Document) -> list[Command]:
        """Return the commands of an event, which could be carried out on this bench."""
        commands = _commands(event)
        for command in commands:
            # a controller that is computed outside comes to the bench with the run
            is_apart = (
                isinstance(command, Switch) and self.spec.library.block("control", command.switch, "switch").apart
            )
            if not is_apart:
                check(self.spec, command)
        if (when := commands[0].when) is not None:
            parse_condition(when, self._signals)
        return commands

    @cached_property
    def _signals(self) -> list[str]:
        """Signals that a condition may name."""
        return signals_of(self.spec).names

    @classmethod
    def load(cls, text: str | Document, like: Scenario | None = None) -> Scenario:
        """Read a scenario from TOML or from a document.

        Parameters
        ----------
        text : str or dict
            The scenario.
        like : Scenario, optional
            A scenario that may be alike, such as another point of a campaign: parts that both have are taken from
            there.

        Raises
        ------
        InputError
            Naming the field, or the line of malformed TOML.
        """
        return cls(text if isinstance(text, dict) else read_toml(text, "scenario"), like)

    def with_numbers(self, values: dict[str, float], write: Callable[[], Document]) -> Scenario:
        """Return the scenario that has other numbers of the bench at some paths, and is alike otherwise.

        ``write`` returns its document when it is first asked for.

        Raises
        ------
        InputError
            When it is not valid; the field may be named as the normal form has it.
        """
        found = object.__new__(Scenario)
        vars(found).update(vars(self), spec=changed(self.spec, values), _write=write)
        for name in ("document", "bench"):
            vars(found).pop(name, None)
        found.twins = twin_specs(found.bench) if self.twins else self.twins
        found._check_length()
        return found

    @cached_property
    def document(self) -> Document:
        """The document it was read from, with the installed packages whose blocks it names."""
        return self._write()

    @cached_property
    def bench(self) -> Document:
        """The part of the document that describes the bench."""
        return {key: value for key, value in self.document.items() if key not in HEAD}

    @property
    def id(self) -> str:
        """Library id."""
        return self.head.id

    @property
    def samples(self) -> int | None:
        """Length in ticks, or None if it has no end."""
        if self.head.duration_ms is not None:
            return max(1, round(self.head.duration_ms / self.spec.dt_ms))
        record = self.spec.record
        if self.head.samples is None and record is not None:
            return None if record.is_growing else record.samples
        return self.head.samples

    @property
    def verdict(self) -> Verdict | None:
        """The word for it if all its expectations hold."""
        return overall(entry.promised() for entry in self.head.expect)

    @property
    def warnings(self) -> list[str]:
        """Warnings about claims that are not read, or cannot be judged."""
        rows = self.head.expect
        said = [UNREAD] if self.head.verdict is not None or any(entry.verdict is not None for entry in rows) else []
        return said + [
            f"{entry.metric}: published has no published_value and no published_range, so there is no verdict"
            for entry in rows
            if entry.promised() is None
        ]

    def toml(self, remark: str = "") -> str:
        """Return the scenario as TOML, with a remark above it."""
        import tomlkit  # it writes TOML; Python itself reads it

        above = f"# {remark}\n" if remark else ""
        return schema_line("scenario") + above + tomlkit.dumps(self.document)


def _with_open_ends(document: Document) -> Document:
    """Return the document with the open ends of published ranges as texts, which JSON can carry."""
    rows = document.get("expect")
    if not isinstance(rows, list):
        return document
    closed = [_closed(row) for row in rows]
    return document if all(map(operator.is_, closed, rows)) else {**document, "expect": closed}


def _closed(row: Any) -> Any:
    """Return an expectation with the open ends of its published range as texts."""
    ends = row.get("published_range") if isinstance(row, dict) else None
    if not isinstance(ends, list) or not any(isinstance(end, float) and math.isinf(end) for end in ends):
        return row
    return {**row, "published_range": [str(end) if isinstance(end, float) and math.isinf(end) else end for end in ends]}


def _commands(event: Document) -> list[Command]:
    """Return the commands of an event; unlike a command by hand it must have a time."""
    commands = parse_event(event)
    if all(moment is None for moment in (commands[0].at_sample, commands[0].at_ms, commands[0].when)):
        raise InputError("needs one of at_sample, at_ms, when")
    return commands
