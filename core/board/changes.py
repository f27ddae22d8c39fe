"""The changes that each command makes on a board; a command that is not allowed changes nothing."""

from __future__ import annotations

from functools import cache
from typing import Any, Protocol

import numpy as np
from pydantic import ValidationError

from core.block import BlockParams
from core.board.commands import Command, HealFaults, Inject, MakeSafe, ResetTrip, SetValues, Switch, Trip
from core.board.difference import change
from core.board.fitting import misfit
from core.board.live import live_change, value_at
from core.board.lost import Lost
from core.board.spec import Spec
from core.board.wiring import Wiring, command_of, engage, wire
from core.errors import InputError, from_validation, unknown
from core.faults.fault import FaultParams
from core.format import format_short
from core.loop.guard import BEYOND_TRAVEL, NOT_FINITE, PULLED_IN, REASONS


class ChangeableBoard(Protocol):
    """The board as its commands see it."""

    spec: Spec
    wiring: Wiring
    trip: Trip | None
    lost: Lost | None
    tick: int

    @property
    def dt_ms(self) -> float:
        """Sample interval, ms."""

    def value(self, signal: str) -> float:
        """Return the value of a signal after the last tick."""

    def link(self) -> None:
        """Take over a wiring that has changed."""

    def note(self, actor: str, kind: str, text: str) -> object:
        """Write an entry of the log."""


def check(spec: Spec, command: Command) -> None:
    """Refuse a command for later that could never be carried out on a bench."""
    if isinstance(command, Inject):
        fault_params(spec, command, 0)
    elif isinstance(command, HealFaults):
        _names(spec, command)
    elif isinstance(command, SetValues):
        live_change(spec, command.set)
    elif isinstance(command, Switch):
        live_change(spec, switched(spec, command))


def carry_out(board: ChangeableBoard, command: Command) -> tuple[Any, Any]:
    """Carry out a command at this tick; return the values before it and after it."""
    if isinstance(command, Inject):
        return inject(board, command)
    if isinstance(command, HealFaults):
        return heal(board, command)
    if isinstance(command, SetValues):
        return set_values(board, command.set)
    if isinstance(command, Switch):
        return switch(board, command)
    if isinstance(command, MakeSafe):
        return make_safe(board, command.make_safe)
    assert isinstance(command, ResetTrip)
    return reset_trip(board)


def inject(board: ChangeableBoard, command: Inject) -> tuple[Any, Any]:
    """Put a fault on the device from this tick on."""
    params = fault_params(board.spec, command, board.tick)
    current = board.spec.faults.get(command.fault)
    old, new = current.model_dump() if current is not None else None, params.model_dump()
    if old is not None and {**old, "start_tick": board.tick} == new:
        raise InputError(
            f"{command.fault} is already there with severity {format_short(command.severity, '')}",
            "fault",
            "heal it first, or give another severity",
            "conflict",
        )
    _change(board, board.spec.with_faults({**board.spec.faults, command.fault: params}))
    return old, new


def heal(board: ChangeableBoard, command: HealFaults) -> tuple[Any, Any]:
    """Take faults away at this tick."""
    names = _names(board.spec, command)
    if command.heal == "all":
        names = [name for name in names if name in board.spec.faults]
    absent = [name for name in names if name not in board.spec.faults]
    if absent:
        present = ", ".join(board.spec.faults) or "none"
        raise InputError(f"{absent[0]} is not there to heal; present: {present}", "heal", code="conflict")
    old = {name: board.spec.faults[name].model_dump() for name in names}
    _change(board, board.spec.with_faults({k: v for k, v in board.spec.faults.items() if k not in names}))
    return old, None


def set_values(board: ChangeableBoard, values: dict[str, Any]) -> tuple[Any, Any]:
    """Change parameters by path, all in this tick."""
    spec, old, new = live_change(board.spec, values)
    _change(board, spec)
    return old, new


def switch(board: ChangeableBoard, command: Switch) -> tuple[Any, Any]:
    """Give the drive of its slot to another controller."""
    values = switched(board.spec, command)
    ((path, name),) = values.items()
    old = value_at(board.spec, path)
    if name == old and not command.cold:
        raise InputError(f"{name} drives already", "switch", "choose another, or a cold start", "conflict")
    spec, _, _ = live_change(board.spec, values)
    _change(board, spec)
    ran_away = not np.all(np.isfinite(board.wiring.state_of(name)))
    if ran_away:  # no block in shadow trips the board, and a state that is not finite does not recover
        board.note("board", "warning", f"{name} had run away in shadow, so it starts anew")
    if command.cold or ran_away:
        instance = board.wiring.instances[board.wiring.row(name)]
        board.wiring.state_of(name)[:] = instance.block.initial(instance.params, spec.context(instance.every))
    return old, name


def switched(spec: Spec, command: Switch) -> dict[str, Any]:
    """Return the path of a controller's slot, and the controller's name."""
    block = spec.library.block("control", command.switch, "switch")
    if reason := misfit(block, spec.plant.block):
        raise InputError(f"{block.name} {reason}", "switch", f"there are: {', '.join(spec.controllers)}")
    last = list(spec.driving)[-1]
    path = f"slots.{block.slot}" if block.slot in spec.driving and block.slot != last else "controller.kind"
    return {path: block.name}


def touched(spec: Spec, command: Command) -> set[str]:
    """Return the paths of a bench that a command writes."""
    if isinstance(command, Switch):
        return {*switched(spec, command)}
    return {*command.set} if isinstance(command, SetValues) else set()


def disengage(board: ChangeableBoard) -> None:
    """Take the voltage off, as a trip does."""
    for instance in board.wiring.instances:
        if instance.prefix.split(".")[0] in ("drive", "amplifier"):
            for port in instance.block.outputs:
                board.wiring.w[board.wiring.index[f"{instance.prefix}.{port.name}"]] = 0.0


def make_safe(board: ChangeableBoard, reason: str) -> tuple[Any, Any]:
    """Trip the board at this tick for a reason that no signal shows."""
    if board.trip is not None:
        raise InputError("the board has tripped already", "make_safe", code="conflict")
    board.trip = Trip(tick=board.tick, time_ms=board.tick * board.dt_ms, reason=reason, signal="", value=None)
    disengage(board)
    return None, board.trip.model_dump()


def cause(board: ChangeableBoard) -> tuple[str, str]:
    """Return why the board stopped, in words, and the signal that says so."""
    axes = board.spec.axes
    axis = next((axis for axis in axes if board.value(f"guard.{axis}.trip") != 0.0), "")
    prefix = f"guard.{axis}" if axis else "guard"
    code = int(board.value(f"{prefix}.trip"))
    text, signal = REASONS[code]
    moved = (f"plant.{axis}", f"plant.{axis}_velocity") if axis else ("plant.displacement", "plant.velocity")
    if axis:
        signal = {BEYOND_TRAVEL: moved[0], PULLED_IN: signal}.get(code, f"drive.{axis}.force")
    if code == NOT_FINITE:
        command = command_of(board.spec, axis) if axis else f"{board.spec.active}.voltage"
        signal = next((name for name in moved if not np.isfinite(board.value(name))), command)
    return text, signal


def reset_trip(board: ChangeableBoard) -> tuple[Any, Any]:
    """Leave the tripped state: every block starts anew, time and faults continue."""
    if board.trip is None:
        raise InputError("the board has not tripped", "reset_trip", code="conflict")
    old = board.trip.model_dump()
    fresh = wire(board.spec)
    fresh.left_out = board.wiring.left_out
    for instance in fresh.instances:
        if instance.key.endswith(".score") and np.isfinite(board.wiring.state_of(instance.key)).all():
            fresh.state_of(instance.key)[:] = board.wiring.state_of(instance.key)
            for port in (*instance.block.outputs, *instance.block.taps):
                name = f"{instance.prefix}.{port.name}"
                fresh.w[fresh.index[name]] = board.value(name)
    board.wiring = fresh
    board.link()
    board.trip = board.lost = None
    return old, None


def _names(spec: Spec, command: HealFaults) -> list[str]:
    known = list(spec.library.blocks("faults"))
    if command.heal == "all":
        return known
    for name in command.heal:
        if name not in known:
            raise unknown("fault", name, known, "heal")
    return list(command.heal)


def fault_params(spec: Spec, command: Inject, tick: int) -> BlockParams:
    """Return the parameters of the fault that a command injects at a tick.

    Raises
    ------
    InputError
        For a fault that the plant cannot have, and for parameters that it does not take.
    """
    block = spec.library.block("faults", command.fault, "fault")
    reason = misfit(block, spec.plant.block)
    if reason:
        raise InputError(f"{block.name} {reason}", "fault")
    own = _own_parameters(block.Params)
    for name in command.parameters:
        if name not in own:
            raise unknown("parameter", name, own, f"parameters.{name}")
    try:
        return block.Params.model_validate(
            {"severity": command.severity, "profile": command.profile, "start_tick": tick, **command.parameters}
        )
    except ValidationError as error:
        found = from_validation(error)
        raise (found.under("parameters") if found.field.split(".")[0] in own else found) from None


@cache
def _own_parameters(params: type[BlockParams]) -> list[str]:
    """Return the names of the parameters that a fault has besides its severity and profile."""
    return [name for name in params.model_fields if name not in FaultParams.model_fields]


def _change(board: ChangeableBoard, spec: Spec) -> None:
    """Put another bench of the same signals on the board; blocks that are alike keep their states."""
    if not change(board.wiring, board.spec, spec):
        board.wiring = _exchanged(board.wiring, spec)
    board.spec = spec
    board.link()


def _exchanged(old: Wiring, spec: Spec) -> Wiring:
    """Return the wiring of a bench in which a block has been exchanged, has come or is gone; the others keep on."""
    new = wire(spec, old)
    assert new.signals.names == old.signals.names
    for name, place in new.index.items():
        # until an amplifier comes, the command arrives as it is
        known = name if name in old.index else name.replace("amplifier.", "drive.", 1)
        if known in old.index:
            new.w[place] = old.w[old.index[known]]
    engage(spec, new.index, new.w)
    for after in new.instances:
        row = old.rows.get(after.key)
        if row is not None and old.instances[row].block is after.block:
            new.state_of(after.key)[:] = old.state_of(after.key)
    return new
