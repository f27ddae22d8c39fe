"""Inverse: the commands that take a change of a board back, from now on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from core.board.commands import Command, HealFaults, Inject, MakeSafe, SetValues, Switch
from core.board.document import Document
from core.board.log import LogEntry
from core.faults.fault import FaultParams, Profile

SORT = ("kind", "model")
"""Parameters that choose a block, whose other parameters go with it."""
IN_USE = ("controller", "sensor", "slots")
"""Sections that only point at a block."""


def inverse(command: Command, entry: LogEntry, before: Document) -> list[Command]:
    """Return the commands that undo a command on a board.

    They do not restore states: an estimator keeps everything it has learnt since then.

    Parameters
    ----------
    command : Command
        The command; not the reset of a trip, which only a return to the moment before undoes.
    entry : LogEntry
        Its entry in the log, with the values before it.
    before : dict
        The document of the bench before it.
    """
    if isinstance(command, Inject):
        return [HealFaults(heal=[command.fault]) if entry.old is None else _inject(command.fault, entry.old)]
    if isinstance(command, HealFaults):
        return [_inject(name, params) for name, params in entry.old.items()]
    if isinstance(command, MakeSafe):
        return []  # a trip is left by its reset alone
    if isinstance(command, Switch):
        return [Switch(switch=entry.old)] if entry.old != entry.new else []
    assert isinstance(command, SetValues)
    return [SetValues(set=_values(command.set, entry.old, before))]


def _inject(fault: str, params: Mapping[str, Any]) -> Inject:
    """Return the command that puts a fault back; its profile begins anew."""
    others = {name: value for name, value in params.items() if name not in FaultParams.model_fields}
    profile = Profile.model_validate(params["profile"])
    return Inject(fault=fault, severity=params["severity"], profile=profile, parameters=others)


def _values(paths: Mapping[str, Any], old: Mapping[str, Any], before: Document) -> dict[str, Any]:
    """Return the values of before: one by one, or the whole section where a block was exchanged."""
    sections, values = {}, {}
    for path in paths:
        section, _, leaf = path.rpartition(".")
        was, around = _at(before, path), _at(before, section)
        exchanged = leaf in SORT and section not in IN_USE
        if isinstance(was, dict):
            sections[path] = was
        elif isinstance(around, dict) and (exchanged or (was is None and old[path] is None)):
            sections[section] = around
        else:
            values[path] = old[path] if was is None else was
    return sections | {path: value for path, value in values.items() if path.rpartition(".")[0] not in sections}


def _at(document: Document, path: str) -> Any:
    """Return the value at a path of a document, None where the default applies."""
    found: Any = document
    for name in path.split("."):
        found = found.get(name) if isinstance(found, dict) else None
    return found
