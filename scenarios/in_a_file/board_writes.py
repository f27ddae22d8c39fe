"""The numbers that commands write into the arrays of one board, found by carrying them out on copies of it."""

from __future__ import annotations

import copy
from itertools import product
from typing import Any

import numpy as np

from core.block import Block, BlockParams, FloatArray
from core.board import changes
from core.board.board import Board
from core.board.commands import Command, Inject, SetValues, Switch
from core.board.difference import change
from core.board.ensemble import is_own
from core.board.instances import usual_params
from core.board.live import live_change, value_at
from core.board.wiring import Wiring, wire
from core.errors import InputError

ARRAYS = ("p", "io", "w")
"""Arrays that a change of the wiring writes; states are written by no change."""
MOST_WIRINGS = 64
"""Choices of the controllers that drive in all slots."""


class BoardWrites:
    """The commands to a board, each with the numbers it writes.

    Parameters
    ----------
    board : Board
        At its first tick.
    own : sequence of str
        Dotted paths of the values that a twin has for itself; a command of the main board does not reach them.
    """

    def __init__(self, board: Board, own: list[str] | None = None) -> None:
        self.spec, self.wiring = board.spec, board.wiring
        self._own = own or []
        self.blocked: dict[str, str] = {}
        """Controllers that the board can switch to and its file cannot, each with the reason."""

    def takes(self, command: Command) -> bool:
        """Say whether a command of the main board reaches this board, which does not refuse it."""
        try:
            if not self.keeps_own(command):
                changes.check(self.spec, command)
                return not isinstance(command, SetValues) or all(
                    value_at(self.spec, path) is not None for path in command.set
                )
        except InputError:
            pass
        return False

    def keeps_own(self, command: Command) -> bool:
        """Say whether a command of the main board is for a value that the twin has for itself."""
        if isinstance(command, Switch) and command.switch in self.spec.controllers:
            return any(path in self._own for path in changes.switched(self.spec, command))
        return isinstance(command, SetValues) and all(is_own(path, self._own) for path in command.set)

    # -- faults

    def fault(self, name: str, command: Inject) -> dict[str, Any]:
        """Return the places of a fault; refuse a fault that writes more than its own numbers."""
        row = self.wiring.row(f"faults.{name}")
        block = self.wiring.instances[row].block
        self._check_fault(row, command)
        return {"row": row, "start": _start_of(block), "absent": self._packed(row, usual_params(block))}

    def packed(self, row: int, command: Inject) -> FloatArray:
        """Return the numbers of a fault that begins at tick 0."""
        return self._packed(row, changes.fault_params(self.spec, command, 0))

    def _packed(self, row: int, params: BlockParams) -> FloatArray:
        instance = self.wiring.instances[row]._replace(params=params)
        return instance.packed(self.spec.context(instance.every, instance.axis))

    def _check_fault(self, row: int, command: Inject) -> None:
        """Refuse a fault that writes more than its own numbers, or whose first state depends on it."""
        board = copy.deepcopy(self.wiring)
        params = changes.fault_params(self.spec, command, 0)
        spec = self.spec.with_faults({**self.spec.faults, command.fault: params})
        if not change(board, self.spec, spec):
            raise InputError("makes another wiring")
        own = board.packed(row)
        own[:] = self.wiring.packed(row)
        if not all(is_same(getattr(board, name), getattr(self.wiring, name)) for name in ("p", "io", "w", "table")):
            raise InputError("writes numbers of other blocks")
        instance = board.instances[row]
        first = instance.block.initial(instance.params, spec.context(instance.every, instance.axis))
        if not is_same(first, self.wiring.state_of(instance.key)):
            raise InputError("begins in a state that depends on its severity")

    # -- controllers

    def wirings(self) -> dict[str, Any]:
        """Return the slot of each controller, and for each choice of all slots the numbers that it writes."""
        slots = {name: [one for one in self.spec.controllers if self._slot(one) == name] for name in self.spec.driving}
        choices = [*product(*slots.values())]
        if len(choices) > MOST_WIRINGS:
            self.blocked = dict.fromkeys(self.spec.controllers, "too many choices of controllers")
            choices = [tuple(self.spec.driving.values())]
        made = {"+".join(choice): wiring for choice in choices if (wiring := self._with(choice)) is not None}
        return {
            "slots": {name: slot for slot, names in slots.items() for name in names},
            "driving": dict(self.spec.driving),
            "writes": _differences(self.wiring, made),
        }

    def _slot(self, controller: str) -> str:
        ((path, _),) = changes.switched(self.spec, Switch(switch=controller)).items()
        return [*self.spec.driving][-1] if path == "controller.kind" else path.removeprefix("slots.")

    def _with(self, choice: tuple[str, ...]) -> Wiring | None:
        spec, wiring = self.spec, copy.deepcopy(self.wiring)
        for name in choice:
            if name in spec.driving.values():
                continue
            try:
                after = live_change(spec, changes.switched(spec, Switch(switch=name)))[0]
            except InputError:
                return None  # the board refuses it too
            if not change(wiring, spec, after):
                self._block(choice, "makes another wiring")
                return None
            spec = after
        if is_same(wiring.table, self.wiring.table) and wiring.unread == self.wiring.unread:
            return wiring
        self._block(choice, "other blocks run")
        return None

    def _block(self, choice: tuple[str, ...], reason: str) -> None:
        self.blocked |= dict.fromkeys({*choice} - {*self.spec.driving.values()}, reason)

    # -- values

    def places_of_faults(self) -> set[int]:
        """Return the places of the numbers of all faults."""
        rows = [row for row, one in enumerate(self.wiring.instances) if one.key.startswith("faults.")]
        begins = {row: int(self.wiring.table[row, 1]) for row in rows}
        return {at for row in rows for at in range(begins[row], begins[row] + len(self.wiring.packed(row)))}

    def with_values(self, values: dict[str, Any]) -> Wiring:
        """Return the wiring of the board with other values by path."""
        wiring = copy.deepcopy(self.wiring)
        if not change(wiring, self.spec, live_change(self.spec, values)[0]):
            raise InputError("makes another wiring")
        return wiring

    def check_values(self, values: dict[str, Any]) -> None:
        """Refuse values that write more than parameters, or on which a first state depends."""
        wiring = self.with_values(values)
        fresh = wire(live_change(self.spec, values)[0], wiring)
        same = [is_same(getattr(wiring, name), getattr(self.wiring, name)) for name in ("io", "w", "table")]
        if not all(same) or wiring.absent != self.wiring.absent or wiring.unread != self.wiring.unread:
            raise InputError("other blocks run")
        if not is_same(fresh.s, self.wiring.s):
            raise InputError("a first state depends on it")


def is_same(one: Any, other: Any) -> bool:
    """Say whether two arrays have the same bits."""
    return np.array_equal(one.view(np.int64), other.view(np.int64))


def _start_of(block: type[Block]) -> int:
    return next((field.offset for field in block.Packed.layout.fields if field.name == "start_tick"), -1)


def _differences(base: Wiring, made: dict[str, Wiring]) -> dict[str, Any]:
    """Return for each wiring the numbers at all places at which any of them differs from the base."""
    found: dict[str, Any] = {}
    for name in ARRAYS:
        before = getattr(base, name).view(np.int64)
        others = {key: getattr(wiring, name).view(np.int64) for key, wiring in made.items()}
        places = np.flatnonzero(np.any([one != before for one in others.values()], axis=0))
        numbers = {key: getattr(wiring, name)[places] for key, wiring in made.items()}
        found[name] = {"places": places, "numbers": numbers}
    return found
