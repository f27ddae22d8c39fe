"""Supervision: the act that a supervisor requests, as commands to its board.

A request is a signal, so it is copied, stored and computed again with all others. A board keeps no other note of it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from core.block import FloatArray
from core.board import changes
from core.board.commands import Command, MakeSafe, SetValues, Switch, parse_command
from core.board.document import SUPERVISOR
from core.board.live import value_at
from core.board.spec import Spec
from core.board.wiring import Wiring
from core.errors import InputError

REQUEST = f"{SUPERVISOR}.request"


class Consequence(NamedTuple):
    """An act that was carried out at a tick edge, and why."""

    tick: int
    command: Command
    reason: str


class RequestedActs(NamedTuple):
    """The commands of a request, and its reason in words."""

    commands: list[Command]
    reason: str


def watched(spec: Spec, wiring: Wiring, watches: FloatArray) -> FloatArray:
    """Return the rows that the loop watches, and a row for the request if there is a supervisor."""
    if not spec.supervisors:
        return watches
    return np.vstack([watches, [[wiring.index[REQUEST], 1.0, 0.5]]])


def take_request(spec: Spec, wiring: Wiring) -> RequestedActs | None:
    """Return the request of the last tick that is not carried out yet, and reset it.

    Raises
    ------
    InputError
        For an act that is no command.
    """
    place = wiring.index.get(REQUEST)
    if place is None or not wiring.w[place] > 0.0:
        return None
    request = int(wiring.w[place])
    wiring.w[place] = 0.0
    section = spec.supervisors[SUPERVISOR]
    block: Any = section.block

    def value(signal: str) -> float:
        return float(wiring.w[wiring.index[signal]])

    arguments = section.params, spec.context(), request, value
    commands = [parse_command(act) for act in block.acts(*arguments)]
    return RequestedActs([one for own in commands if (one := _left(spec, own))], block.reason(*arguments))


def check(spec: Spec) -> None:
    """Refuse a supervisor with an act that could never be carried out.

    Raises
    ------
    InputError
        Naming the parameter of the supervisor.
    """
    for section in spec.supervisors.values():
        block: Any = section.block
        try:
            for request in range(1, block.requests(section.params, spec.context()) + 1):
                for act in block.acts(section.params, spec.context(), request, lambda _: 1.0):
                    _check_act(spec, act)
        except InputError as error:
            raise error.under(SUPERVISOR) from None


def _check_act(spec: Spec, act: Any) -> None:
    command = parse_command(act)
    if not isinstance(command, Switch | SetValues | MakeSafe):
        raise InputError("a supervisor switches, sets or makes the outputs safe", "acts")
    if any(value is not None for value in (command.at_sample, command.at_ms, command.when)):
        raise InputError("an act takes effect at once, and names no moment", "acts")
    if isinstance(command, SetValues) and any(path.split(".")[0] == SUPERVISOR for path in command.set):
        raise InputError("a supervisor does not change its own parameters", "acts")
    changes.check(spec, command)


def _left(spec: Spec, command: Command) -> Command | None:
    """Return the part of a command that changes something; nothing if nothing would change."""
    if isinstance(command, Switch):
        ((path, name),) = changes.switched(spec, command).items()
        return command if value_at(spec, path) != name else None
    if isinstance(command, SetValues):
        left = {path: value for path, value in command.set.items() if value_at(spec, path) != value}
        return command.model_copy(update={"set": left}) if left else None
    return command
