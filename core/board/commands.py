"""Commands: everything that can be done to a running board, in the notation of a scenario's events."""

from __future__ import annotations

from functools import cache
from typing import Any, ClassVar, Literal, Self, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from core.board.document import Document
from core.errors import InputError, from_validation, unknown_field
from core.faults.fault import Profile
from core.table import Table, Words

LONGEST_MS = 1e12
"""Latest moment that can be named, device time: beyond any run, and whole in samples."""


class Timed(Table):
    """When a command takes effect: now, at a sample, at a time, or once a condition holds."""

    model_config = ConfigDict(frozen=True)

    kind: ClassVar[str]
    """Its name in the log."""

    at_sample: int | None = Field(None, ge=0, description="the sample at which the command takes effect")
    at_ms: float | None = Field(
        None, ge=0, le=LONGEST_MS, description="the device time at which the command takes effect, ms"
    )
    when: str | None = Field(
        None,
        max_length=200,
        description="the condition at which the command takes effect, '<signal> > <value>' or '<signal> < <value>'; "
        "it counts from at_sample on",
    )

    @model_validator(mode="after")
    def _one_moment(self) -> Self:
        if self.at_ms is not None and (self.at_sample is not None or self.when is not None):
            raise ValueError("takes one of at_sample, at_ms and when; only at_sample and when go together")
        return self

    def tick(self, dt_ms: float) -> int | None:
        """Return the tick the command waits for; None if it waits for no tick."""
        return round(self.at_ms / dt_ms) if self.at_ms is not None else self.at_sample

    def at(self, sample: int | None, when: str | None = None) -> Self:
        """Return the same command for another moment."""
        if (self.at_sample, self.at_ms, self.when) == (sample, None, when):
            return self
        return self.model_copy(update={"at_sample": sample, "at_ms": None, "when": when})

    def document(self) -> Document:
        """Return the command as an event of a scenario, without the fields that have their default."""
        said = {name for name, default in _defaults(type(self)) if getattr(self, name) != default}
        return self.model_dump(mode="json", include=said)


@cache
def _defaults(model: type[Timed]) -> list[tuple[str, Any]]:
    """Return the fields of a command with their defaults."""
    return [(name, info.default) for name, info in model.model_fields.items()]


class ResetTrip(Timed):
    """Leave the tripped state, with all blocks started anew."""

    kind = "reset_trip"
    reset_trip: Literal[True] = Field(description="leave the tripped state")


class HealFaults(Timed):
    """Take faults away."""

    kind = "heal"
    heal: list[str] | Literal["all"] = Field(description="faults to take away, by name, or all of them")


class Inject(Timed):
    """Inject a fault, or give a present fault another severity."""

    kind = "inject"
    fault: str = Field(description="name of the fault")
    severity: float = Field(description="size of the fault, in its own unit")
    profile: Profile = Field(Profile(), description="how the severity comes")
    parameters: dict[str, Any] = Field(
        default={}, max_length=20, description="the other parameters of the fault, by name"
    )


class SetValues(Timed):
    """Set parameters by their paths, all in one tick."""

    kind = "set"
    set: dict[str, Any] = Field(min_length=1, max_length=100, description="values by dotted path")


class Switch(Timed):
    """Give the drive to another controller; cold starts it anew, otherwise it takes over as it ran in shadow."""

    kind = "switch"
    switch: str = Field(description="name of the controller that drives from then on")
    cold: bool = Field(False, description="start it anew, not as it ran in shadow")


class MakeSafe(Timed):
    """Take the outputs to their safe values, as a trip does; says why."""

    kind = "make_safe"
    make_safe: str = Field(min_length=1, max_length=200, description="the reason, in words")


Command = ResetTrip | HealFaults | Inject | SetValues | Switch | MakeSafe
COMMANDS: dict[str, type[Command]] = {
    "reset_trip": ResetTrip,
    "heal": HealFaults,
    "fault": Inject,
    "set": SetValues,
    "switch": Switch,
    "make_safe": MakeSafe,
}
"""The commands by the field that names each; commands of one event take effect in this order."""
FIELDS = tuple(dict.fromkeys(name for model in COMMANDS.values() for name in model.model_fields))
T = TypeVar("T", bound=Timed)


def parse_event(document: Any) -> list[Command]:
    """Check an event, which may do several things at once; return its commands in the order they take effect.

    Raises
    ------
    InputError
        For an unknown field, a field that nothing in the event needs, or a value that is not allowed.
    """
    if not isinstance(document, dict):
        raise InputError("a command must be a table", "command")
    said = {key: value for key, value in document.items() if value is not None}
    if said.get("reset_trip") is False:
        del said["reset_trip"]
    for field in said:
        if field not in FIELDS:
            raise unknown_field(field, FIELDS, field)
    models = [model for field, model in COMMANDS.items() if field in said]
    if not models:
        raise InputError(f"needs one of {', '.join(COMMANDS)}")
    for field in said:
        if not any(field in model.model_fields for model in models):
            whose = next(name for name, model in COMMANDS.items() if field in model.model_fields)
            raise InputError(f"goes with {whose}, which is not there", field)
    return [check(model, {key: said[key] for key in model.model_fields if key in said}) for model in models]


def parse_command(document: Any) -> Command:
    """Check a command: an event that does a single thing.

    Raises
    ------
    InputError
        As `parse_event`, and when it does several things.
    """
    command, *others = parse_event(document)
    if others:
        first, second, *_ = [field for field in COMMANDS if field in document]
        raise InputError(f"a command does one thing: {first} and {second} are two", second)
    return command


def check(model: type[T], document: Document) -> T:
    """Return a command of a known sort.

    Raises
    ------
    InputError
        For an unknown field or a value that is not allowed.
    """
    try:
        return model.model_validate(document)
    except ValidationError as error:
        raise from_validation(error, {"": list(model.model_fields)}) from None


class Trip(BaseModel):
    """Why the board stopped."""

    tick: int
    time_ms: float
    reason: Words
    signal: str
    value: float | None
