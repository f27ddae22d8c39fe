"""A supervisor as a table: for each request the switch, the numbers or the trip that it asks for.

A supervisor has such a table if its acts follow from the number of its request alone. An act may also depend on
signals: a law that is set to an estimate has numbers that only the packing in Python computes.
"""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np

from core.board import supervision
from core.board.commands import Command, SetValues, parse_command
from core.board.document import SUPERVISOR
from core.board.live import value_at
from core.board.spec import Spec
from core.errors import InputError
from scenarios.in_a_file.board_writes import BoardWrites

OF_SIGNALS = "it has a supervisor that sets a law to an estimate, and the numbers of the law are computed in Python"
OF_OTHERS = "it has a supervisor whose acts set different values"


class _AskedError(Exception):
    """An act asks for a signal."""


def _asks(_: str) -> NoReturn:
    raise _AskedError


def acts_of(spec: Spec) -> list[list[Command]]:
    """Return the acts of each request of the supervisor of a bench, from request 1 on; none without a supervisor.

    Raises
    ------
    InputError
        When an act depends on signals, or sets other values than another act.
    """
    section = spec.supervisors.get(SUPERVISOR)
    if section is None:
        return []
    block: Any = section.block
    context = spec.context()
    try:
        found = [
            [parse_command(act) for act in block.acts(section.params, context, request, _asks)]
            for request in range(1, block.requests(section.params, context) + 1)
        ]
    except _AskedError:
        raise InputError(OF_SIGNALS) from None
    if len({tuple(sorted(one.set)) for acts in found for one in acts if isinstance(one, SetValues)}) > 1:
        raise InputError(OF_OTHERS)
    return found


def refused_supervisor(spec: Spec) -> str:
    """Return why the supervisor of a bench has no table; nothing if it has one, or if there is none."""
    try:
        acts_of(spec)
    except InputError as error:
        return error.message
    return ""


def supervisor_table(board: BoardWrites) -> dict[str, Any] | None:
    """Return the table of the supervisor of a board, if it has one.

    Raises
    ------
    InputError
        When its acts depend on signals, or write more than the numbers of blocks.
    """
    requests = acts_of(board.spec)
    if not requests:
        return None
    paths = sorted({path for acts in requests for one in acts if isinstance(one, SetValues) for path in one.set})
    made = {
        number: board.with_values(one.set).p
        for number, acts in enumerate(requests, 1)
        for one in acts
        if isinstance(one, SetValues)
    }
    for acts in requests:
        for one in acts:
            if isinstance(one, SetValues):
                board.check_values(one.set)
    before = board.wiring.p.view(np.int64)
    differs = [numbers.view(np.int64) != before for numbers in made.values()]
    places = np.flatnonzero(np.any(differs, axis=0)) if differs else np.zeros(0, dtype=np.int64)
    return {
        "place": board.wiring.index[supervision.REQUEST],
        "values": {path: value_at(board.spec, path) for path in paths},
        "places": places,
        "requests": [
            [
                {"act": _described(one), **({"numbers": made[number][places]} if isinstance(one, SetValues) else {})}
                for one in acts
            ]
            for number, acts in enumerate(requests, 1)
        ],
    }


def supervisor_switches(table: dict[str, Any] | None) -> list[str]:
    """Return the controllers that a supervisor switches to."""
    acts = [one["act"] for acts in (table or {}).get("requests", []) for one in acts]
    return [act["switch"] for act in acts if "switch" in act]


def _described(command: Command) -> dict[str, Any]:
    return command.at(None).document()
