"""The commands of a bench that a file has: faults, switches and values, each with the numbers it writes.

A board and its twins carry out the same commands, so a value moves freely only where it does on all of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from core.block import Block, BlockParams, FloatArray
from core.board.board import Board
from core.board.commands import Command, HealFaults, Inject, SetValues, Switch
from core.board.ensemble import Ensemble
from core.board.instances import faults_of
from core.board.live import section_at, value_at
from core.cards import ParameterCard, parameter_cards
from core.errors import InputError
from core.faults.fault import FaultParams, Profile
from scenarios.in_a_file.board_writes import BoardWrites
from scenarios.in_a_file.dependence import dependence
from scenarios.in_a_file.supervisor_table import supervisor_switches, supervisor_table
from scenarios.knobs import usual_range
from scenarios.schema import Scenario

REACH = 10.0
"""The usual range of a severity, in suggested severities; as on the page."""
LEAST_SHARE, END_SHARE = 0.5, 0.05
OfBoards = dict[str, Any]
"""Something of each board by the name of the twin; the name of the main board is empty."""
MAIN = ""


class Writes:
    """The commands of a bench that a file has, each with the numbers it writes.

    Parameters
    ----------
    board : Board
        At its first tick, with its twins.
    scenario : Scenario
        Its severities and values that events name are exact.
    """

    def __init__(self, board: Board, scenario: Scenario) -> None:
        self._spec = board.spec
        self.boards = {MAIN: BoardWrites(board)}
        if isinstance(board, Ensemble):
            self.boards |= {name: BoardWrites(twin, board.own_paths(name)) for name, twin in board.twins.items()}
        self._events = [command for commands in scenario.events for command in commands]
        self.supervisors: OfBoards = {name: supervisor_table(one) for name, one in self.boards.items()}
        """The table of the supervisor of each board, if it has one."""
        self.left_out: list[str] = []
        """Commands that the file has not, each with the reason."""

    def _taking(self, command: Command) -> dict[str, BoardWrites]:
        """Return the boards that carry out a command: the main board and the twins that it reaches."""
        return {name: board for name, board in self.boards.items() if name == MAIN or board.takes(command)}

    # -- faults

    def faults(self) -> OfBoards:
        """Return for each board its faults: row, severities, and the numbers in each variant that an event names."""
        found: OfBoards = {name: {} for name in self.boards}
        for name, block in faults_of(self._spec.axes, self._spec.library).items():
            try:
                for board, entry in self._fault(name, block).items():
                    found[board][name] = entry
            except InputError as error:
                self.left_out.append(f"{name}: {error}")
        return found

    def _fault(self, name: str, block: type[Block]) -> OfBoards:
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
        boards = self._taking(plain)
        entries = {
            key: {
                **board.fault(name, plain),
                "title": block.title,
                "group": block.group,
                "shows": block.shows or None,
                "unit": card.unit,
                "suggested": suggested,
                "minimum": card.minimum,
                "maximum": card.maximum,
                "low": low,
                "high": high,
                "variants": [],
            }
            for key, board in boards.items()
        }
        for command in variants:

            def packed(key: str, severity: float, command: Inject = command) -> FloatArray:
                changed = command.model_copy(update={"severity": severity})
                return boards[key].packed(entries[key]["row"], changed)

            for key, own_dependence in _dependences(packed, [*boards], low, high, exact).items():
                entries[key]["variants"].append(
                    {
                        "parameters": variant(command),
                        "packed": packed(key, suggested),
                        "dependence": own_dependence,
                    }
                )
        return entries

    def present(self, faults: OfBoards) -> OfBoards:
        """Return for each board the faults that act from the first tick on, as the page knows them."""
        return {
            key: {
                name: {**described(_present(name, params), faults[MAIN]), "since": params.start_tick}  # type: ignore[attr-defined]
                for name, params in board.spec.faults.items()
            }
            for key, board in self.boards.items()
        }

    # -- controllers

    def wirings(self) -> OfBoards:
        """Return for each board its slots and choices; the main board has no choice that a twin cannot follow."""
        found = {name: board.wirings() for name, board in self.boards.items()}
        for name, table in self.supervisors.items():
            if table is not None and {*table["places"].tolist()} & {*found[name]["writes"]["p"]["places"].tolist()}:
                raise InputError("a switch of the controller writes the numbers that it sets", "supervisor")
            for act in supervisor_switches(table):
                if act in self.boards[name].blocked:
                    raise InputError(f"its file cannot switch to {act}", "supervisor")
        main, *twins = self.boards.values()
        blocked = {
            controller: reason
            for twin in twins
            for controller, reason in twin.blocked.items()
            if twin.takes(Switch(switch=controller))
        }
        self.left_out += [f"switch to {name}: {reason}" for name, reason in (blocked | main.blocked).items()]
        away = {*blocked} - {*self._spec.driving.values()}
        for part in found[MAIN]["writes"].values():
            part["numbers"] = {k: one for k, one in part["numbers"].items() if not away & {*k.split("+")}}
        return found

    # -- values

    def values(self) -> OfBoards:
        """Return for each board the values that may be set, by path, each with the numbers that follow it."""
        found: OfBoards = {name: {} for name in self.boards}
        taken = {name: board.places_of_faults() for name, board in self.boards.items()}
        for name, table in self.supervisors.items():
            taken[name] |= {*table["places"].tolist()} if table is not None else set()
        for path, card, is_named in self._settable():
            try:
                entries = self._value(path, card)
            except InputError as error:
                self.left_out.append(f"set {path}: {error}")
                continue
            places = {name: {*entry["dependence"]["places"].tolist()} for name, entry in entries.items()}
            if not any(places.values()) and not is_named:
                continue
            if any(own & taken[name] for name, own in places.items()):
                self.left_out.append(f"set {path}: its numbers follow another value too")
                continue
            for name, entry in entries.items():
                taken[name] |= places[name]
                found[name][path] = entry
        return found

    def _settable(self) -> Iterator[tuple[str, ParameterCard, bool]]:
        """Return the paths of live numbers, each with its card, and whether an event of the scenario sets it."""
        spec = self._spec
        named = {path for one in self._events if isinstance(one, SetValues) for path in one.set}
        heads = [*spec.generators, f"sensors.{spec.measuring}", "plant"]
        heads = ["reference", *heads] if not spec.axes else heads
        for head in dict.fromkeys([*heads, *(path.rpartition(".")[0] for path in sorted(named))]):
            section = section_at(spec, head)
            for card in parameter_cards(section.block.Params) if section is not None else ():
                path = f"{head}.{card.name}"
                value = value_at(spec, path)
                is_number = isinstance(value, int | float) and not isinstance(value, bool)
                is_wanted = head in heads and (head != "plant" or "noise" in card.name)
                if is_number and card.live and card.type == "number" and (is_wanted or path in named):
                    yield path, card, path in named

    def _value(self, path: str, card: ParameterCard) -> OfBoards:
        value = float(value_at(self._spec, path))
        low, high, _ = usual_range(card.name, value, card)
        named = [one.set[path] for one in self._events if isinstance(one, SetValues) and path in one.set]
        low, high = (self._allowed(path, one, value) for one in (min(low, *named, value), max(high, *named, value)))
        exact = [value, *map(float, named)]
        boards = self._taking(SetValues(set={path: value}))
        for board in boards.values():
            board.check_values({path: low + 0.75 * (high - low)})
        described_value = {"label": card.label, "unit": card.unit, "value": value, "low": low, "high": high}

        def packed(key: str, one: float) -> FloatArray:
            return boards[key].with_values({path: one}).p

        return {
            key: {**described_value, "dependence": own}
            for key, own in _dependences(packed, [*boards], low, high, exact).items()
        }

    def _allowed(self, path: str, end: float, value: float) -> float:
        """Return an end of a range, or a number a little before it where the end itself is refused."""
        try:
            self.boards[MAIN].with_values({path: end})
        except InputError:
            return end + END_SHARE * (value - end)
        return end


def _dependences(
    packed: Callable[[str, float], FloatArray], boards: list[str], low: float, high: float, exact: list[float]
) -> OfBoards:
    """Return how the numbers of each board follow a value, in one way for all of them."""
    ends = np.cumsum([0, *(len(packed(key, exact[0])) for key in boards)])
    whole = dependence(lambda one: np.concatenate([packed(key, one) for key in boards]), low, high, exact)
    found = {}
    for key, first, end in zip(boards, ends, ends[1:], strict=False):
        inside = (whole["places"] >= first) & (whole["places"] < end)
        own = {"places": whole["places"][inside] - first}
        if "factors" in whole:
            own["factors"] = whole["factors"][inside]
        else:
            own |= {"grid": whole["grid"], "numbers": np.ascontiguousarray(whole["numbers"][:, inside])}
        found[key] = own
    return found


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
