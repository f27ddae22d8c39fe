"""A board as plain data: the commands to it and its numbers; from these it continues, bit for bit.

The wiring is not stored. It follows from the bench and from the commands to it, in that order; only its numbers are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.board import changes
from core.board.board import Board
from core.board.commands import Trip, parse_command
from core.board.condition import parse_condition
from core.board.document import Document
from core.board.ensemble import Ensemble, make
from core.board.lost import Lost
from core.board.pending import PendingCommand, PendingQueue
from core.board.supervision import Consequence
from core.errors import InputError

Arrays = Mapping[str, NDArray[Any]]
NUMBERS = ("p", "s", "w", "io")


@dataclass(frozen=True)
class Stored:
    """A board at a tick edge.

    Parameters
    ----------
    document : dict
        Its bench, its commands and its progress; JSON can hold all of it.
    arrays : mapping of str to ndarray
        Copies of its numbers.
    """

    document: Document
    arrays: Arrays = field(repr=False)


def stored(board: Board) -> Stored:
    """Return a board as plain data, independent of the board from then on."""
    document, arrays = _one(board)
    document["base"] = board.base
    if isinstance(board, Ensemble):
        document |= {"mirrored": board.mirrored, "warned": sorted(board.warned), "twins": {}}
        for name, twin in board.twins.items():
            document["twins"][name], own = _one(twin)
            arrays |= {f"{name}:{key}": value for key, value in own.items()}
    return Stored(document, arrays)


def revived(kept: Stored) -> Board:
    """Return a board that continues from a stored state.

    Raises
    ------
    InputError
        If this version gives the bench other numbers.
    """
    board = make(kept.document["base"])
    _go_on(board, kept.document, kept.arrays)
    if isinstance(board, Ensemble):
        board.mirrored, board.warned = kept.document["mirrored"], set(kept.document["warned"])
        for name, twin in board.twins.items():
            prefix = f"{name}:"
            own = {key.removeprefix(prefix): value for key, value in kept.arrays.items() if key.startswith(prefix)}
            _go_on(twin, kept.document["twins"][name], own)
    return board


def _one(board: Board) -> tuple[Document, dict[str, NDArray[Any]]]:
    last, cautions = board.observer.seen()
    document = {
        "tick": board.tick,
        "done": [[tick, command.document()] for tick, command in board.done],
        "consequences": [[one.tick, one.command.document(), one.reason] for one in board.consequences],
        "pending": [_waiting(entry) for entry in board.pending],
        "asked": board.pending.asked,
        "lost": board.lost,
        "trip": board.trip.model_dump(mode="json") if board.trip is not None else None,
        "used": sorted(board.used),
        "cautions": cautions,
    }
    arrays = {name: getattr(board.wiring, name).copy() for name in NUMBERS}
    return document, {**arrays, "folds": board.folds.copy(), "last": last}


def _go_on(board: Board, document: Document, arrays: Arrays) -> None:
    """Carry out the stored commands on a board at tick 0, then give it the stored numbers."""
    # a consequence comes before the commands of its tick
    for tick, command, *reason in sorted([*document.get("consequences", []), *document["done"]], key=itemgetter(0)):
        parsed = parse_command(command)
        board.tick = tick
        if parsed.kind == "reset_trip":  # only a board that has tripped takes it; here no tick has run
            board.trip = Trip(tick=tick, time_ms=0.0, reason="", signal="", value=None)
        changes.carry_out(board, parsed)
        if reason:
            board.consequences.append(Consequence(tick, parsed, *reason))
        else:
            board.done.append((tick, parsed))
    board.tick, board.used = document["tick"], set(document["used"])
    board.trip = Trip.model_validate(document["trip"]) if document["trip"] is not None else None
    board.lost = Lost(*document["lost"]) if document.get("lost") else None
    board.pending = PendingQueue.of([_entry(entry, board) for entry in document["pending"]], document["asked"])
    for name in NUMBERS:
        _fill(getattr(board.wiring, name), arrays[name])
    _fill(board.folds, arrays["folds"])
    board.observer.go_on(arrays["last"], document["cautions"])


def _fill(numbers: NDArray[Any], kept: NDArray[Any]) -> None:
    if numbers.shape != kept.shape or numbers.dtype != kept.dtype:
        raise InputError("this version gives the bench other numbers")
    np.copyto(numbers, kept)


def _waiting(entry: PendingCommand) -> Document:
    return {
        "command": entry.command.document(),
        "actor": entry.actor,
        "tick": entry.tick,
        "watched": entry.condition is not None,
        "since": entry.since,
        "number": entry.number,
    }


def _entry(kept: Document, board: Board) -> PendingCommand:
    command = parse_command(kept["command"])
    watched = parse_condition(command.when or "", board.wiring.signals.names) if kept["watched"] else None
    return PendingCommand(command, kept["actor"], kept["tick"], watched, kept["since"], kept["number"])
