"""Shared functions of commands: lines and documents printed, scenarios found, bad input in one line."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Sequence
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, ParamSpec, TypeVar

import typer

from core.errors import InputError
from scenarios.own import with_units
from scenarios.schema import Scenario
from scenarios.source import document_of

AssignOption = Annotated[
    list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="Any field of the scenario.")
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print one JSON document.")]


def say(text: str = "") -> None:
    """Print a line."""
    sys.stdout.write(text + "\n")


def say_json(document: Any) -> None:
    """Print a JSON document."""
    say(json.dumps(document, indent=2, allow_nan=False))


P = ParamSpec("P")
T = TypeVar("T")


def plainly(command: Callable[P, T]) -> Callable[P, T]:
    """Turn bad input into one line and exit code 2."""

    @wraps(command)
    def guarded(*args: P.args, **kwargs: P.kwargs) -> T:
        try:
            return command(*args, **kwargs)
        except InputError as error:
            hint = f" ({error.hint})" if error.hint else ""
            sys.stderr.write(f"combbench: {error}{hint}\n")
            raise typer.Exit(2) from None

    return guarded


def load(name: str, units: Sequence[Path] | None = None) -> Scenario:
    """Return the scenario that a command names (`document_of`), with units from files."""
    return Scenario.load(with_units(document_of(name), units or ()))
