"""A game: a seed hides something, a person hands in numbers, a stated rule gives points."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, Generic, TypeVar

from pydantic import BaseModel, Field, ValidationError

from core.block import BlockParams, Equation
from core.board.document import Document
from core.device.frequency import figures
from core.errors import InputError, from_validation
from core.format import format_short
from scenarios.schema import Scenario

DIAGNOSER = "kalman"
"""Id of the bank on the bench of every game."""
MOST = 2**53
"""The largest seed."""


class GameInput(BlockParams):
    """The numbers that a person hands in."""


H = TypeVar("H", bound=GameInput)


class Outcome(BaseModel):
    """The points of a hand-in, and why."""

    points: float
    figures: dict[str, float] = Field(description="The numbers of the rule, by name")
    said: str = Field(description="What came of it, in words")
    worked: str = Field(description="The rule with its numbers put in, as LaTeX")


class Fact(BaseModel):
    """Something that was hidden, in words."""

    name: str
    said: str


class Kind(BaseModel):
    """A fault that can be named, and between which ends."""

    name: str
    title: str
    unit: str
    minimum: float
    maximum: float


def device_fact(bench: Scenario) -> Fact:
    """Tell the device of a bench."""
    device = bench.spec.device.resolved
    parts = (device["mass_kg"], "kg"), (device["stiffness_n_m"], "N/m")
    said = ", ".join(format_short(value, unit, 3) for value, unit in parts)
    return Fact(name="Device", said=f"{said}, resonance at {format_short(figures(**device)['f0_hz'], 'Hz')}")


class Game(ABC, Generic[H]):
    """Base of the games; one file each.

    Attributes
    ----------
    id, title, summary : str
        How a list names it.
    task, rule : str
        They describe the task, and the rule of the points.
    equations : tuple of Equation
        The rule.
    attempts : int
        How often one person may hand in at one seed.
    form : type of HandIn
        The numbers that people hand in.
    turned : tuple of str
        The parameters that a player may change on the live bench while it runs.
    """

    id: ClassVar[str]
    title: ClassVar[str]
    summary: ClassVar[str]
    task: ClassVar[str]
    rule: ClassVar[str]
    equations: ClassVar[tuple[Equation, ...]]
    attempts: ClassVar[int]
    form: type[H]
    turned: ClassVar[tuple[str, ...]] = ()

    def kinds(self, seed: int) -> list[Kind]:
        """Return the faults that can be named at a seed; none if no fault is to be named."""
        del seed
        return []

    def read(self, seed: int, values: Mapping[str, Any]) -> H:
        """Check an answer at a seed.

        Raises
        ------
        InputError
            Naming the field, the error and the allowed values.
        """
        del seed
        try:
            return self.form.model_validate(dict(values))
        except ValidationError as error:
            raise from_validation(error, {"": [*self.form.model_fields]}) from None

    @abstractmethod
    def bench(self, seed: int, handed: H | None = None) -> Document:
        """Return the live bench of a seed as a scenario, the bank set to the answer."""

    @abstractmethod
    def judge(self, seed: int, handed: H) -> Outcome:
        """Return the points of an answer: the same bits for the same seed and numbers."""

    @abstractmethod
    def hidden(self, seed: int) -> list[Fact]:
        """Return the hidden values of a seed."""


def check_seed(seed: int) -> int:
    """Refuse a number that is no seed.

    Raises
    ------
    InputError
        Saying which numbers are.
    """
    if not 0 <= seed <= MOST:
        raise InputError(f"must be a whole number from 0 to {MOST}, got {seed}", "seed")
    return seed
