"""A lecture: cues in order, each an exact state of a bench, its panels, and notes to speak from."""

from __future__ import annotations

from functools import cached_property
from typing import Any, Literal, Self

from pydantic import Field, ValidationError, model_validator

from core.board.commands import LONGEST_MS
from core.errors import InputError, from_validation
from core.nesting import read_toml
from core.table import Table, Words
from scenarios.edit import written
from scenarios.expectation import Expectation
from scenarios.library import get
from scenarios.measure.stretch import Stretch
from scenarios.reading import without_address
from scenarios.run import build, run
from scenarios.schema import Scenario

Panel = Literal[
    "adaptation",
    "allan",
    "behaviour",
    "board",
    "card",
    "claims",
    "controllers",
    "device",
    "environment",
    "events",
    "faults",
    "hypotheses",
    "identify",
    "lanes",
    "locus",
    "narrator",
    "parameters",
    "phase",
    "schematic",
    "scores",
    "sensor",
    "spectrum",
    "twins",
    "view3d",
    "why",
]
"""Views of the panels of the page that a lecture can show; each belongs to one panel."""
MOST_CUES = 40
LONGEST_TICKS = 5_000_000
"""Ticks of an experiment: a cue is reached from tick 0 while a class waits."""


class Span(Table):
    """A stretch of device time."""

    from_ms: float = Field(ge=0, le=LONGEST_MS, description="where it begins, ms")
    until_ms: float = Field(ge=0, le=LONGEST_MS, description="where it ends, ms")

    @model_validator(mode="after")
    def _forward(self) -> Self:
        if self.from_ms >= self.until_ms:
            raise ValueError("from_ms must be less than until_ms")
        return self


class Question(Table):
    """A question to a class before the answer is shown: which lane of a diagnoser rises, or one of some answers."""

    text: Words = Field(min_length=1, max_length=300, description="the question")
    answers: list[Words] = Field([], max_length=6, description="the options; none for a question about lanes")
    diagnoser: str = Field("", max_length=64, description="whose lanes are the answers")
    when: Span | None = Field(None, description="device time within which a moment is guessed, too")
    right: Words = Field("", max_length=100, description="the right answer, shown with the votes")

    @model_validator(mode="after")
    def _answerable(self) -> Self:
        if bool(self.answers) == bool(self.diagnoser):
            raise ValueError("give answers or a diagnoser")
        if self.answers and not 2 <= len(set(self.answers)) == len(self.answers):
            raise ValueError("answers must be two to six different ones")
        if any(not 1 <= len(answer) <= 100 for answer in self.answers):
            raise ValueError("an answer has 1 to 100 characters")
        return self


class Cue(Table):
    """A cue: with ``scenario`` it begins an experiment, without it continues the experiment of the cue before."""

    title: Words = Field(min_length=1, max_length=100, description="title of the cue")
    minutes: float = Field(gt=0, le=60, description="planned length, minutes")
    say: Words = Field(min_length=1, max_length=4000, description="notes to speak from")
    ask: Words = Field("", max_length=1000, description="a question to the room")
    see: Words = Field("", max_length=1000, description="what will be seen")
    scenario: str | None = Field(None, max_length=64, description="id of the library; begins an experiment at tick 0")
    seed: int | None = Field(None, ge=0, le=2**63 - 1, description="seed of all noise; the seed of the scenario")
    set: dict[str, Any] = Field({}, description="dotted paths of the scenario and their values")
    events: list[dict[str, Any]] = Field([], max_length=100, description="its commands, in the notation of a scenario")
    from_ms: float | None = Field(
        None, ge=0, le=LONGEST_MS, description="where it begins, ms; where the cue before ends"
    )
    until_ms: float | None = Field(
        None, ge=0, le=LONGEST_MS, description="where it ends, ms; without it the bench is paused"
    )
    pace_ms_per_s: float | None = Field(
        None, ge=1e-3, le=1000, description="device time for each second of the room, ms/s"
    )
    layout: Literal["lecture", "lab", "research"] | None = Field(None, description="the layout of the cue before")
    panels: list[Panel] = Field([], max_length=6, description="views of panels brought to the front")
    signals: list[str] = Field([], max_length=6, description="on the first scope")
    window_ms: float | None = Field(None, gt=0, le=LONGEST_MS, description="width of the first scope, ms")
    metrics: Stretch | None = Field(None, description="the part of the run that the expectations speak of")
    expect: list[Expectation] = Field([], max_length=20, description="claims of the notes, at the end of the cue")
    vote: Question | None = Field(None, description="a question to the class before the answer is shown")

    @model_validator(mode="after")
    def _beginning(self) -> Self:
        if self.scenario is None and (self.seed is not None or self.set):
            raise ValueError("seed and set go with scenario: they are of the beginning of an experiment")
        return self


class LectureHead(Table):
    """A lecture as it is written."""

    title: Words = Field(min_length=1, max_length=200, description="title of the lecture")
    chapter: int = Field(ge=1, le=6, description="chapter of the text")
    summary: Words = Field("", max_length=2000, description="what it is about")
    cues: list[Cue] = Field(alias="cue", min_length=1, max_length=MOST_CUES, description="the cues in their order")


class State:
    """The state of a bench at a cue.

    Parameters
    ----------
    scenario : Scenario
        All of the experiment up to the end of the cue; run headless it gives the same bits.
    from_tick, until_tick : int
        Where the cue begins and ends.
    """

    def __init__(self, scenario: Scenario, from_tick: int, until_tick: int) -> None:
        self.scenario, self.from_tick, self.until_tick = scenario, from_tick, until_tick


class Lecture:
    """A checked lecture.

    Parameters
    ----------
    id : str
        The name of its file.
    document : dict
        Content of the file.
    """

    def __init__(self, id: str, document: dict[str, Any]) -> None:
        self.id = id
        try:
            self.head = LectureHead.model_validate(without_address(document))
        except ValidationError as error:
            raise _placed(from_validation(error, {"": ["title", "chapter", "summary", "cue"]})) from None
        if self.head.cues[0].scenario is None:
            raise _placed(InputError("is required: the first cue begins an experiment", "cue.0.scenario"))

    @classmethod
    def load(cls, id: str, text: str) -> Lecture:
        """Read a lecture from TOML, and check each of its cues.

        Raises
        ------
        InputError
            Naming the lecture, the cue and the field.
        """
        try:
            lecture = cls(id, read_toml(text, "lecture"))
            _ = lecture.states
        except InputError as error:
            raise error.under(id) from None
        return lecture

    @property
    def minutes(self) -> float:
        """How long it is planned to take."""
        return sum(cue.minutes for cue in self.head.cues)

    @cached_property
    def states(self) -> list[State]:
        """The state of each cue.

        Raises
        ------
        InputError
            Naming the cue and the field.
        """
        found: list[State] = []
        for position, cue in enumerate(self.head.cues):
            try:
                found.append(_state(cue, found[-1] if found else None))
            except InputError as error:
                raise _placed(error.under(f"cue.{position}")) from None
        return found

    def check(self) -> dict[str, Any]:
        """Run every cue headless; return the claims of the notes with the measured values, JSON-ready."""
        cues = []
        for cue, state in zip(self.head.cues, self.states, strict=True):
            summary = run(state.scenario, figures_only=True).summary()
            kept = {name: summary[name] for name in ("ticks", "digest", "expectations", "ok")}
            cues.append({"title": cue.title, **kept})
        return {"lecture": self.id, "title": self.head.title, "minutes": self.minutes, "cues": cues}


def _state(cue: Cue, before: State | None) -> State:
    """Return the state of a cue, which may continue the experiment of the cue before."""
    if cue.scenario is not None or before is None:
        library = get(cue.scenario or "")
        document = written(library.document, cue.set)
        if library.study is not None:
            raise InputError(f"{library.id} is a study, which runs on no bench", "scenario")
        document = {key: value for key, value in document.items() if key not in ("claim", "source", "duration_ms")}
        begins, done = 0, list(document.get("events", []))
    else:
        document, begins = before.scenario.document, before.until_tick
        done = list(document["events"])
    dt_ms = before.scenario.spec.dt_ms if cue.scenario is None and before else Scenario.load(_bare(document)).spec.dt_ms
    first = begins if cue.from_ms is None else round(cue.from_ms / dt_ms)
    if first < begins:
        raise InputError(f"is before {begins * dt_ms:g} ms, where the cue before ends", "from_ms")
    last = first if cue.until_ms is None else round(cue.until_ms / dt_ms)
    if not first <= last <= LONGEST_TICKS:
        raise InputError(f"must be from {first * dt_ms:g} ms to {LONGEST_TICKS * dt_ms:g} ms", "until_ms")
    document = {
        **document,
        "samples": max(1, last),
        "events": done + cue.events,
        "expect": [entry.model_dump(exclude_defaults=True) for entry in cue.expect],
    }
    if cue.seed is not None:
        document["seed"] = cue.seed
    if cue.metrics is not None:
        document["metrics"] = cue.metrics.model_dump()
    try:
        scenario = Scenario.load(document)
        known = {signal.name for signal in build(scenario).signals}
    except InputError as error:
        raise InputError(error.message, _of_cue(error.field, len(done)), error.hint, error.code) from None
    for position, commands in enumerate(scenario.events[len(done) :]):
        tick = commands[0].tick(dt_ms)
        if tick is not None and not first <= tick <= last:
            span = f"{first * dt_ms:g} ms to {last * dt_ms:g} ms"
            raise InputError(f"is at {tick * dt_ms:g} ms, outside the cue, {span}", f"events.{position}")
    for position, name in enumerate(cue.signals):
        if name not in known:
            raise InputError(f"this bench has no signal {name}", f"signals.{position}")
    if cue.vote is not None and cue.vote.diagnoser and cue.vote.diagnoser not in scenario.spec.diagnosers:
        raise InputError(f"this bench has no diagnoser {cue.vote.diagnoser}", "vote.diagnoser")
    return State(scenario, first, last)


def _bare(document: dict[str, Any]) -> dict[str, Any]:
    """Return a scenario without its events and expectations."""
    return {key: value for key, value in document.items() if key not in ("events", "expect", "printed")}


def _of_cue(field: str, done: int) -> str:
    """Return the field of a cue for a field of its scenario: its events come after the events of the cues before."""
    parts = field.split(".")
    if parts[0] == "events" and len(parts) > 1:
        return ".".join(["events", str(int(parts[1]) - done), *parts[2:]])
    return field


def _placed(error: InputError) -> InputError:
    """Return an error that counts cues as people do."""
    parts = error.field.split(".")
    if parts[0] == "cue" and len(parts) > 1 and parts[1].isdigit():
        parts[:2] = [f"cue {int(parts[1]) + 1}"]
    return InputError(error.message, ".".join(parts), error.hint, error.code)
