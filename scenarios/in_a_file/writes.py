"""The numbers that commands write into the arrays of a bench, found by carrying them out on copies of its board."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from core.block import Block, BlockParams, FloatArray
from core.board import changes
from core.board.board import Board
from core.board.commands import Command, HealFaults, Inject, SetValues, Switch
from core.board.difference import change
from core.board.instances import faults_of, usual_params
from core.board.live import live_change, section_at, value_at
from core.board.wiring import Wiring, wire
from core.cards import ParameterCard, parameter_cards
from core.errors import InputError
from core.faults.fault import FaultParams, Profile
from scenarios.in_a_file.dependence import dependence
from scenarios.knobs import usual_range
from scenarios.schema import Scenario

ARRAYS = ("p", "io", "w")
"""Arrays that a change of the wiring writes; states are written by no change."""
MOST_WIRINGS = 64
"""Choices of the controllers that drive in all slots."""
REACH = 10.0
"""The usual range of a severity, in suggested severities; as on the page."""
LEAST_SHARE, END_SHARE = 0.5, 0.05


class Writes:
    """The commands of a bench that a file has, each with the numbers it writes.

    Parameters
    ----------
    board : Board
        At its first tick.
    scenario : Scenario
        Its severities and values that events name are exact.
    """

    def __init__(self, board: Board, scenario: Scenario) -> None:
        self._board, self._spec, self._wiring = board, board.spec, board.wiring
        self._events = [command for commands in scenario.events for command in commands]
        self.left_out: list[str] = []
        """Commands that the file has not, each with the reason."""

    def faults(self) -> dict[str, Any]:
        """Return of each fault its row, its severities, and its numbers in each variant that an event names."""
        found = {}
        for name, block in faults_of(self._spec.axes, self._spec.library).items():
            try:
                found[name] = self._fault(name, block)
            except InputError as error:
                self.left_out.append(f"{name}: {error}")
        return found

    def _fault(self, name: str, block: type[Block]) -> dict[str, Any]:
        row = self._wiring.row(f"faults.{name}")
        card = next(one for one in parameter_cards(block.Params) if one.name == "severity")
        suggested = float(block.suggested or card.default or 0.05)
        low, high = _severities(card, suggested)
        own = [command for command in self._events if isinstance(command, Inject) and command.fault == name]
        if name in self._spec.faults:
            own.insert(0, _present(name, self._spec.faults[name]))
        exact = [suggested, *(command.severity for command in own if command.severity)]
        plain = Inject(fault=name, severity=suggested)
        variants = [plain]
        for command in own:
            if variant(command) not in map(variant, variants):
                variants.append(command)
        self._check_alone(row, plain)
        return {
            "row": row,
            "title": block.title,
            "group": block.group,
            "unit": card.unit,
            "suggested": suggested,
            "minimum": card.minimum,
            "maximum": card.maximum,
            "low": low,
            "high": high,
            "start": _start_of(block),
            "absent": self._absent(row, block),
            "variants": [
                {
                    "parameters": variant(command),
                    "packed": self._packed(row, command, suggested),
                    "dependence": dependence(partial(self._packed, row, command), low, high, exact),
                }
                for command in variants
            ],
        }

    def _packed(self, row: int, command: Inject, severity: float) -> FloatArray:
        """Return the numbers of a fault that begins at tick 0."""
        params = self._params(command.model_copy(update={"severity": severity}))
        instance = self._wiring.instances[row]._replace(params=params)
        return instance.packed(self._spec.context(instance.every, instance.axis))

    def _absent(self, row: int, block: type[Block]) -> FloatArray:
        """Return the numbers of a fault that is not there."""
        instance = self._wiring.instances[row]._replace(params=usual_params(block))
        return instance.packed(self._spec.context(instance.every, instance.axis))

    def _params(self, command: Inject) -> BlockParams:
        return changes.fault_params(self._spec, command, 0)

    def _check_alone(self, row: int, command: Inject) -> None:
        """Refuse a fault that writes more than its own numbers, or whose first state depends on it."""
        board = copy.deepcopy(self._wiring)
        spec = self._spec.with_faults({**self._spec.faults, command.fault: self._params(command)})
        if not change(board, self._spec, spec):
            raise InputError("makes another wiring")
        own = board.packed(row)
        own[:] = self._wiring.packed(row)
        if not all(_is_same(getattr(board, name), getattr(self._wiring, name)) for name in ("p", "io", "w", "table")):
            raise InputError("writes numbers of other blocks")
        instance = board.instances[row]
        first = instance.block.initial(instance.params, spec.context(instance.every, instance.axis))
        if not _is_same(first, self._wiring.state_of(instance.key)):
            raise InputError("begins in a state that depends on its severity")

    def present(self, faults: dict[str, Any]) -> dict[str, Any]:
        """Return the faults that act from the first tick on, as the page knows them."""
        return {
            name: {**described(_present(name, params), faults), "since": params.start_tick}  # type: ignore[attr-defined]
            for name, params in self._spec.faults.items()
        }

    # -- controllers

    def wirings(self) -> dict[str, Any]:
        """Return the slot of each controller, and for each choice of all slots the numbers that it writes."""
        slots = {
            name: [one for one in self._spec.controllers if self._slot(one) == name] for name in self._spec.driving
        }
        choices = [*product(*slots.values())]
        if len(choices) > MOST_WIRINGS:
            choices = [tuple(self._spec.driving.values())]
            self.left_out.append("switches: too many choices of controllers")
        made = {"+".join(choice): wiring for choice in choices if (wiring := self._with(choice)) is not None}
        return {
            "slots": {name: slot for slot, names in slots.items() for name in names},
            "driving": dict(self._spec.driving),
            "writes": _differences(self._wiring, made),
        }

    def _slot(self, controller: str) -> str:
        ((path, _),) = changes.switched(self._spec, Switch(switch=controller)).items()
        return [*self._spec.driving][-1] if path == "controller.kind" else path.removeprefix("slots.")

    def _with(self, choice: tuple[str, ...]) -> Wiring | None:
        spec, wiring = self._spec, copy.deepcopy(self._wiring)
        for name in choice:
            if name in spec.driving.values():
                continue
            try:
                after = live_change(spec, changes.switched(spec, Switch(switch=name)))[0]
                if not change(wiring, spec, after):
                    raise InputError("makes another wiring")
            except InputError as error:
                self.left_out.append(f"switch to {name}: {error}")
                return None
            spec = after
        if _is_same(wiring.table, self._wiring.table) and wiring.unread == self._wiring.unread:
            return wiring
        self.left_out.append(f"switch to {choice[-1]}: other blocks run")
        return None

    # -- values

    def values(self) -> dict[str, Any]:
        """Return the values that may be set, by path, each with the numbers that follow it."""
        found: dict[str, Any] = {}
        taken: set[int] = {
            place
            for row, one in enumerate(self._wiring.instances)
            if one.key.startswith("faults.")
            for place in self._span(row)
        }
        for path, card in self._settable():
            try:
                entry = self._value(path, card)
            except InputError as error:
                self.left_out.append(f"set {path}: {error}")
                continue
            places = set(entry["dependence"]["places"].tolist())
            if not places:
                continue
            if places & taken:
                self.left_out.append(f"set {path}: its numbers follow another value too")
                continue
            taken |= places
            found[path] = entry
        return found

    def _span(self, row: int) -> range:
        first = int(self._wiring.table[row, 1])
        return range(first, first + len(self._wiring.packed(row)))

    def _settable(self) -> Iterator[tuple[str, ParameterCard]]:
        spec = self._spec
        heads = [*spec.generators, f"sensors.{spec.measuring}", "plant"]
        heads = ["reference", *heads] if not spec.axes else heads
        named = {path for one in self._events if isinstance(one, SetValues) for path in one.set}
        for head in heads:
            section = section_at(spec, head)
            for card in parameter_cards(section.block.Params) if section is not None else ():
                path = f"{head}.{card.name}"
                value = value_at(spec, path)
                is_number = isinstance(value, int | float) and not isinstance(value, bool)
                is_wanted = head != "plant" or "noise" in card.name
                if is_number and card.live and card.type == "number" and (is_wanted or path in named):
                    yield path, card

    def _value(self, path: str, card: ParameterCard) -> dict[str, Any]:
        value = float(value_at(self._spec, path))
        low, high, _ = usual_range(card.name, value, card)
        named = [one.set[path] for one in self._events if isinstance(one, SetValues) and path in one.set]
        low, high = (self._allowed(path, one, value) for one in (min(low, *named, value), max(high, *named, value)))
        exact = [value, *map(float, named)]
        self._check_parameters_alone(path, low + 0.75 * (high - low))
        return {
            "label": card.label,
            "unit": card.unit,
            "value": value,
            "low": low,
            "high": high,
            "dependence": dependence(lambda one: self._set(path, one).p, low, high, exact),
        }

    def _allowed(self, path: str, end: float, value: float) -> float:
        """Return an end of a range, or a number a little before it where the end itself is refused."""
        try:
            self._set(path, end)
        except InputError:
            return end + END_SHARE * (value - end)
        return end

    def _set(self, path: str, value: float) -> Wiring:
        wiring = copy.deepcopy(self._wiring)
        if not change(wiring, self._spec, live_change(self._spec, {path: value})[0]):
            raise InputError("makes another wiring")
        return wiring

    def _check_parameters_alone(self, path: str, value: float) -> None:
        """Refuse a value that writes more than parameters, or on which a first state depends."""
        wiring = self._set(path, value)
        fresh = wire(live_change(self._spec, {path: value})[0], wiring)
        same = [_is_same(getattr(wiring, name), getattr(self._wiring, name)) for name in ("io", "w", "table")]
        if not all(same) or wiring.absent != self._wiring.absent or wiring.unread != self._wiring.unread:
            raise InputError("other blocks run")
        if not _is_same(fresh.s, self._wiring.s):
            raise InputError("a first state depends on it")


def _present(name: str, params: BlockParams) -> Inject:
    """Return the command that would inject a present fault."""
    values = params.model_dump()
    own = {key: value for key, value in values.items() if key not in FaultParams.model_fields}
    profile = Profile.model_validate(values["profile"])
    return Inject(fault=name, severity=values["severity"], profile=profile, parameters=own)


def variant(command: Inject) -> dict[str, Any]:
    """Return the profile and the parameters of a fault in a command."""
    return {"profile": command.profile.model_dump(), "parameters": command.parameters}


def described(command: Command, faults: dict[str, Any]) -> dict[str, Any]:
    """Return a command as the page reads it: of a fault with the number of its variant.

    Raises
    ------
    InputError
        For a command that no file has.
    """
    if isinstance(command, Inject):
        if command.fault not in faults:
            raise InputError(f"{command.fault} is not in the file")
        known = [one["parameters"] for one in faults[command.fault]["variants"]]
        return {"fault": command.fault, "severity": command.severity, "variant": known.index(variant(command))}
    if isinstance(command, HealFaults | SetValues | Switch):
        return command.at(None).document()
    raise InputError(f"{command.kind} is no command of a file")


def _severities(card: ParameterCard, suggested: float) -> tuple[float, float]:
    least = -1.0 if card.minimum is None else card.minimum
    most = 1.0 if card.maximum is None else card.maximum
    reach = max(abs(suggested) * REACH, LEAST_SHARE if card.unit in ("", "1") else 0.0)
    low = max(least + 1e-3 * abs(least), -reach) if least < 0.0 else least
    return low, min(most, reach)


def _start_of(block: type[Block]) -> int:
    return next((field.offset for field in block.Packed.layout.fields if field.name == "start_tick"), -1)


def _is_same(one: Any, other: Any) -> bool:
    return np.array_equal(one.view(np.int64), other.view(np.int64))


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
