"""The earlier notation of commands to a board, by a kind: still read, from clients and from the store."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from core.board.commands import HealFaults, Inject, ResetTrip, SetValues, Switch, Timed, check
from core.errors import InputError, unknown_field


class Earlier(Timed):
    """A command that was written in the earlier notation."""

    names: ClassVar[Mapping[str, str]] = {}
    """Old names of fields that have other names now."""
    implied: ClassVar[Mapping[str, Any]] = {}
    """Fields that follow from the kind."""


class EarlierInject(Inject, Earlier):
    """A fault."""


class EarlierHeal(HealFaults, Earlier):
    """A healing."""

    names: ClassVar[Mapping[str, str]] = {"heal": "faults"}
    implied: ClassVar[Mapping[str, Any]] = {"heal": "all"}


class EarlierSet(SetValues, Earlier):
    """New values."""

    names: ClassVar[Mapping[str, str]] = {"set": "values"}


class EarlierSwitch(Switch, Earlier):
    """Another controller."""

    names: ClassVar[Mapping[str, str]] = {"switch": "controller"}


class EarlierResetTrip(ResetTrip, Earlier):
    """The reset of a trip."""

    names: ClassVar[Mapping[str, str]] = {"reset_trip": "kind"}
    implied: ClassVar[Mapping[str, Any]] = {"reset_trip": True}


KINDS: dict[str, type[Earlier]] = {
    model.kind: model for model in (EarlierInject, EarlierHeal, EarlierSet, EarlierSwitch, EarlierResetTrip)
}


def parse_earlier(document: dict[str, Any]) -> Earlier:
    """Check a command with a kind of `KINDS`.

    Raises
    ------
    InputError
        For an unknown field or a value that is not allowed, by the name it has there.
    """
    model = KINDS[document["kind"]]
    fields = {model.names.get(name, name): name for name in model.model_fields}
    rest = {key: value for key, value in document.items() if key != "kind"}
    for key in rest:
        if key not in fields:
            raise unknown_field(key, [name for name in fields if name != "kind"], key)
    try:
        return check(model, {**model.implied, **{fields[key]: value for key, value in rest.items()}})
    except InputError as error:
        raise as_written(error, model) from None


def as_written(error: InputError, model: type[Any]) -> InputError:
    """Return the error with the field as the user wrote it, for a command of this sort."""
    head, dot, rest = error.field.partition(".")
    if issubclass(model, Earlier):
        head = model.names.get(head, head)
    return InputError(error.message, f"{head}{dot}{rest}", error.hint, error.code)


def in_this_notation(events: list[dict[str, Any]] | None) -> list[dict[str, Any]] | None:
    """Return stored events with their commands in the notation of today."""
    return events and [
        {**event, "command": parse_earlier(command).document()}
        if (command := event.get("command")) and command.get("kind") in KINDS
        else event
        for event in events
    ]
