"""A sheet: its head, and sections of text, each with at most one step that the server checks."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

Formula = float | Annotated[str, Field(min_length=1, max_length=300)]
"""A number, or a formula over the facts of the bench."""
Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,31}$")]
Words = Annotated[str, Field(min_length=1, max_length=400)]
Share = Annotated[float, Field(ge=0, le=1)]
NUMBER_COSTS = 0.25
"""Share of the points of a number that a wrong answer costs by default."""


class SheetPart(BaseModel):
    """Base of all parts of a sheet: no field it does not know, no silent conversion."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)


class Drawn(SheetPart):
    """A number that varies with the student: low, low + step, and so on up to high."""

    low: float = Field(description="Smallest number")
    high: float = Field(description="Largest number")
    step: float = Field(gt=0, description="Distance between two numbers")

    @model_validator(mode="after")
    def _has_some(self) -> Self:
        if self.count < 2:
            raise ValueError("high is less than one step above low")
        return self

    @property
    def count(self) -> int:
        """How many numbers there are."""
        return int((self.high - self.low) / self.step + 1e-9) + 1

    def of(self, seed: int) -> float:
        """Return the number that a seed draws."""
        return self.low + seed % self.count * self.step


class SheetBench(SheetPart):
    """The bench that a sheet begins with."""

    scenario: str = Field(description="Id of a scenario of the library")
    drawn_device: bool = Field(False, description="Draw the device from the process spread, one for each student")
    set: dict[str, float | bool | str | dict[str, Any] | list[Any]] = Field({}, description="Written over the scenario")
    time_scale: float | None = Field(
        None, gt=0, le=1, description="Device seconds per wall second; the device's usual scale"
    )


class SheetHead(SheetPart):
    """The front matter."""

    schema_: Literal[1] = Field(alias="schema", description="Version of the notation")
    title: Words = Field(description="Title of the sheet")
    summary: Words = Field(description="Summary for the list of sheets")
    minutes: int = Field(ge=5, le=90, description="Planned length, minutes")
    bench: SheetBench = Field(description="The bench that the sheet begins with")
    draws: dict[Name, Drawn] = Field({}, description="Numbers that vary with the student, by name")
    numbers: dict[Name, Formula] = Field({}, description="Named formulas, each over the facts and the ones before")


class Hint(SheetPart):
    """Help, and its cost; the price is shown before."""

    text: Words = Field(description="The help")
    costs: float = Field(ge=0, description="Points")


class SheetStep(SheetPart):
    """Fields of all steps."""

    id: Name = Field(description="Short name, unique in the sheet")
    points: float = Field(gt=0, le=20, description="Points that the step earns at most")
    hints: list[Hint] = Field([], description="Hints, each for points")


class Limits(SheetPart):
    """A quantity of the bench, and the value that the step requires."""

    label: Words = Field(description="The quantity in words")
    name: Name | None = Field(None, description="Its value when the step is done is the fact <step>_<name>")
    signal: str | None = Field(None, description="Name of a signal")
    measure: Literal["value", "mean", "rms", "peak", "swing", "amplitude", "phase", "share"] = Field(
        "value", description="The figure of the signal"
    )
    over: str | None = Field(None, description="A signal whose rms, swing or amplitude it is divided by")
    setting: str | None = Field(None, description="Dotted path of the bench as it is now")
    verdict: str | None = Field(None, description="Id of a diagnoser: the name of the hypothesis it believes")
    fault: str | None = Field(None, description="The severity of this fault, 0 while it is not there")
    between: tuple[Formula, Formula] | None = Field(None, description="Smallest and largest value, in the unit")
    equals: str | None = Field(None, description="The value of a setting, or the name that a verdict has")
    unit: str = Field("", description="Unit of the values")
    told: bool = Field(True, description="Whether the page shows the limits")

    @model_validator(mode="before")
    @classmethod
    def _pair(cls, values: Any) -> Any:
        """Take a list of two for the limits."""
        if isinstance(values, dict) and isinstance(values.get("between"), list):
            return {**values, "between": tuple(values["between"])}
        return values

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        if sum(source is not None for source in (self.signal, self.setting, self.verdict, self.fault)) != 1:
            raise ValueError("needs one of signal, setting, verdict, fault")
        if (self.between is None) == (self.equals is None):
            raise ValueError("needs between or equals, not both")
        if self.equals is not None and not (self.setting or self.verdict):
            raise ValueError("equals is for a setting or a verdict")
        if self.between is not None and self.verdict:
            raise ValueError("a verdict has a name: use equals")
        return self


class Hold(SheetStep):
    """Conditions that hold together for a time of the device."""

    kind: Literal["hold"] = Field(description="Conditions to hold")
    for_ms: float = Field(gt=0, le=10_000, description="Device time that they hold for, ms")
    window_ms: float = Field(1.0, gt=0, le=1000, description="Looked at at the end of every so much device time, ms")
    conditions: list[Limits] = Field(min_length=1, max_length=8, description="The conditions")
    trace: list[str] = Field([], max_length=3, description="Signals with a small stored trace")


class Option(SheetPart):
    """One of the answers to choose from."""

    id: Name = Field(description="Short name of the option")
    text: Words = Field(description="The option in words")
    share: Share = Field(0.0, description="Share of the points that it earns")
    because: str = Field("", max_length=400, description="The reason, shown with the answer")


class Choice(SheetPart):
    """A question with answers to choose from."""

    options: list[Option] = Field(min_length=2, max_length=8, description="The options")

    @model_validator(mode="after")
    def _has_right_one(self) -> Self:
        if not any(option.share == 1.0 for option in self.options):
            raise ValueError("needs an option with share = 1.0")
        if len({option.id for option in self.options}) != len(self.options):
            raise ValueError("two options have the same id")
        return self


class Partly(SheetPart):
    """A wider tolerance, and the share it earns."""

    within: float = Field(gt=0, lt=1, description="Relative")
    share: Share = Field(description="Share of the points that it earns")


class Mistake(SheetPart):
    """A number that a known mistake leads to, the share it earns, and the name of the mistake."""

    value: Formula = Field(description="The number, in the unit of the question")
    share: Share = Field(0.0, description="Share of the points that it earns")
    because: Words = Field(description="Name of the mistake")


class NumberQuestion(SheetPart):
    """A question for a number."""

    value: Formula = Field(description="The right number, in the unit")
    unit: str = Field("", max_length=20, description="Unit of the answer")
    within: float = Field(0.02, ge=0, lt=1, description="Relative")
    within_absolute: float = Field(0.0, ge=0, description="In the unit")
    partly: Partly | None = Field(None, description="A wider tolerance")
    wrong_unit: Share = Field(0.5, description="Share of the points for the right number in a wrong unit")
    wrong_sign: Share = Field(0.0, description="Share of the points for the right number with the wrong sign")
    right_sign: Share = Field(0.0, description="Share of the points for a wrong number with the right sign")
    mistakes: list[Mistake] = Field([], description="Numbers that known mistakes lead to")


class Answered(SheetStep):
    """A step that is answered in words: a question, or a prediction."""

    question: Words = Field(description="The question")
    choice: Choice | None = Field(None, description="Options to choose from")
    number: NumberQuestion | None = Field(None, description="The number to answer with")
    tries: int = Field(3, ge=1, le=10, description="Number of answers that may be given")
    wrong_costs: float | None = Field(None, ge=0, description="Points that a wrong answer loses")

    @model_validator(mode="after")
    def _asks_one(self) -> Self:
        if (self.choice is None) == (self.number is None):
            raise ValueError("needs choice or number, not both")
        return self

    @property
    def asks(self) -> Choice | NumberQuestion:
        """The question."""
        asked = self.choice or self.number
        assert asked is not None
        return asked

    @property
    def costs(self) -> float:
        """Points that a wrong answer loses; trying all options earns nothing."""
        if self.wrong_costs is not None:
            return self.wrong_costs
        if self.choice is not None:
            return self.points / (len(self.choice.options) - 1)
        return NUMBER_COSTS * self.points


class SheetQuestion(Answered):
    """Answered after a run."""

    kind: Literal["question"] = Field(description="A question after a run")


class Prediction(Answered):
    """Answered once, before a run; its points are shown when a later step is done."""

    kind: Literal["prediction"] = Field(description="A question before a run")
    until: Name = Field(description="The step behind which it is judged")
    tries: Literal[1] = Field(1, description="A prediction is answered once")
    wrong_costs: float | None = Field(0.0, description="Points that a wrong answer loses")


class BlindStep(SheetStep):
    """A blind diagnosis: done with the first answer committed behind the opening of this step."""

    kind: Literal["blind"] = Field(description="A hidden fault to find")


AnyStep = Annotated[Hold | SheetQuestion | Prediction | BlindStep, Field(discriminator="kind")]


@dataclass(frozen=True)
class SheetSection:
    """Text, a step perhaps, and the text that is shown once it is done."""

    heading: str
    text: str
    step: Hold | SheetQuestion | Prediction | BlindStep | None
    after: str
    line: int
    step_line: int = 0


@dataclass(frozen=True)
class Sheet:
    """A lab sheet."""

    id: str
    head: SheetHead
    intro: str
    sections: tuple[SheetSection, ...]
    source: str

    @property
    def steps(self) -> list[Hold | SheetQuestion | Prediction | BlindStep]:
        """The steps in their order."""
        return [section.step for section in self.sections if section.step is not None]

    @property
    def points(self) -> float:
        """The most that a student can earn."""
        return sum(step.points for step in self.steps)

    def step(self, name: str) -> Hold | SheetQuestion | Prediction | BlindStep | None:
        """Return a step, or nothing."""
        return next((step for step in self.steps if step.id == name), None)


INSERTED = re.compile(r"\{\{\s*([^{}|]+?)\s*(?:\|\s*([^{}|]*?)\s*)?\}\}")
"""A number in a text: ``{{formula | unit}}``."""
