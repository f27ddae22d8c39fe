"""Commands: everything that can be done to a running board, and the log of what was done."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError, model_validator

from core.errors import InputError, from_validation, unknown
from core.faults.fault import Profile
from core.table import Table

LONGEST_MS = 1e12
"""Latest moment that can be named, device time: beyond any run, and whole in samples."""


class _Command(Table):
    model_config = ConfigDict(frozen=True)


class Timed(_Command):
    """When a command takes effect: now, at a sample, at a time, or once a condition holds."""

    at_sample: int | None = Field(None, ge=0, description="sample at which it takes effect")
    at_ms: float | None = Field(None, ge=0, le=LONGEST_MS, description="device time at which it takes effect")
    when: str | None = Field(
        None, max_length=200, description="'<signal> > <value>' or '<signal> < <value>', watched from at_sample on"
    )

    @model_validator(mode="after")
    def _one_moment(self) -> Self:
        if self.at_ms is not None and (self.at_sample is not None or self.when is not None):
            raise ValueError("takes one of at_sample, at_ms and when; only at_sample and when go together")
        return self


class Inject(Timed):
    """Inject a fault, or give one that is there another severity."""

    kind: Literal["inject"] = "inject"
    fault: str
    severity: float
    profile: Profile = Profile()
    parameters: dict[str, Any] = Field(default={}, max_length=20, description="what else the fault lets one choose")


class Heal(Timed):
    """Take faults away."""

    kind: Literal["heal"] = "heal"
    faults: list[str] | Literal["all"] = "all"


class Set(Timed):
    """Set parameters by their paths, all in one tick."""

    kind: Literal["set"] = "set"
    values: dict[str, Any] = Field(min_length=1, max_length=100)


class Switch(Timed):
    """Give the drive to another controller; cold starts it anew, otherwise it takes over as it ran in shadow."""

    kind: Literal["switch"] = "switch"
    controller: str
    cold: bool = False


class ResetTrip(Timed):
    """Leave the tripped state, with all blocks started anew."""

    kind: Literal["reset_trip"] = "reset_trip"


Command = Inject | Heal | Set | Switch | ResetTrip
_ADAPTER: TypeAdapter[Command] = TypeAdapter(Annotated[Command, Field(discriminator="kind")])
KINDS: dict[str, type[Timed]] = {
    "inject": Inject,
    "heal": Heal,
    "set": Set,
    "switch": Switch,
    "reset_trip": ResetTrip,
}


def parse_command(document: Any) -> Command:
    """Check a command.

    Raises
    ------
    InputError
        For an unknown kind, an unknown field or a value that is not allowed.
    """
    if not isinstance(document, dict):
        raise InputError("a command must be a table", "command")
    kind = document.get("kind")
    if not isinstance(kind, str) or kind not in KINDS:
        raise unknown("command", kind, KINDS, "kind")
    try:
        return _ADAPTER.validate_python(document)
    except ValidationError as error:
        found = from_validation(error, {kind: list(KINDS[kind].model_fields)})
        found.field = found.field.removeprefix(kind).removeprefix(".")
        raise InputError(found.message, found.field, found.hint, found.code) from None


class LogEntry(BaseModel):
    """One thing that happened, at a tick; the log is append-only."""

    seq: int
    tick: int
    time_ms: float
    actor: str
    kind: str
    text: str
    command: dict[str, Any] | None = None
    old: Any = None
    new: Any = None


class Trip(BaseModel):
    """Why the board stopped."""

    tick: int
    time_ms: float
    reason: str
    signal: str
    value: float | None
