"""The part of a bench that goes into an FMU: plant, environment, faults, sensors, drive and guard."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from core.block import IntArray
from core.board.board import Board
from core.board.program import EVERY, IO_OFFSET, P_OFFSET, S_OFFSET
from core.errors import InputError
from core.signals import Signal
from scenarios.in_a_file.writes import MAIN, Writes
from scenarios.run import build
from scenarios.schema import Scenario

COMMAND = ("command", "command_middle", "command_end")
"""Ports of the drive and the guard that a voltage from outside takes the place of; it is held over a sample."""
COMMANDED = ("drive", "guard")
LEFT_OUT = ("control", "identify", "diagnose", "supervise", "readout")
"""Families of the blocks that no FMU has: the other simulator controls and watches."""


class CommandInput(NamedTuple):
    """A voltage or a force from outside: its name, its unit and its places among the signals."""

    name: str
    unit: str
    places: list[int]


@dataclass(frozen=True)
class FmuLayout:
    """The arrays and the tables of the part.

    Attributes
    ----------
    board : Board
        The bench at its first tick.
    rows : list of int
        The rows of the part, in the order of a tick.
    cut : int
        How many of them come before the voltages.
    io : ndarray
        The places of all ports, with the places of the voltages behind all signals.
    signals : int
        Places of signals.
    commands : list of CommandInput
        The voltages from outside.
    faults, values : dict
        As a bench in a file has them.
    outputs : list of Signal
        The signals that others may read.
    left_out : list of str
        The parts of the bench that the FMU lacks, each with the reason.
    """

    board: Board
    rows: list[int]
    cut: int
    io: IntArray
    signals: int
    commands: list[CommandInput]
    faults: dict[str, Any]
    values: dict[str, Any]
    outputs: list[Signal]
    left_out: list[str]


def refusal(scenario: Scenario) -> str:
    """Return why a scenario cannot be an FMU; nothing if it can."""
    spec = scenario.spec
    reasons = {
        "it is a study, a computation without a bench": scenario.study,
        "its plant is a record, which has no input": spec.record is not None,
        "it has a unit in a text, which is compiled on a server": spec.library.units,
        "its drive moves between samples, and an input is held": spec.is_analogue,
    }
    return next((text for text, holds in reasons.items() if holds), "")


def layout(scenario: Scenario) -> FmuLayout:
    """Return the part of a bench that goes into an FMU.

    Raises
    ------
    InputError
        When it has none, with the reason.
    """
    if reason := refusal(scenario):
        raise InputError(f"{scenario.id} cannot be an FMU: {reason}", "scenario")
    board = build(scenario, compiled=False)
    wiring = board.wiring
    commands, io = _commands(board)
    rows = _rows(board, io)
    writes = Writes(board, scenario)
    faults = writes.faults()[MAIN]
    spans = [range(start := int(wiring.table[row, P_OFFSET]), start + len(wiring.packed(row))) for row in rows]
    own = {place for span in spans for place in span}
    values = {
        path: value
        for path, value in writes.values()[MAIN].items()
        if own.issuperset(value["dependence"]["places"].tolist())
    }
    keys = {wiring.instances[row].key for row in rows}
    events = sum(one.tick is None or one.tick > 0 for one in board.pending)
    left_out = [*writes.left_out, *([f"{events} events of the scenario: set inputs instead"] if events else [])]
    first = min(row for row in rows if wiring.instances[row].key.split(".")[0] == "drive")
    return FmuLayout(
        board=board,
        rows=rows,
        cut=sum(row < first for row in rows),
        io=io,
        signals=len(wiring.w) + sum(len(one.places) for one in commands),
        commands=commands,
        faults=faults,
        values=values,
        outputs=[one for one in wiring.signals if one.block in keys],
        left_out=left_out,
    )


def _commands(board: Board) -> tuple[list[CommandInput], IntArray]:
    """Return the voltages from outside, and the places of all ports once these read them."""
    wiring, io, found = board.wiring, board.wiring.io.copy(), dict[str, CommandInput]()
    for row, instance in enumerate(wiring.instances):
        if instance.key.split(".")[0] not in COMMANDED:
            continue
        for number, port in enumerate(instance.block.inputs):
            if port.name in COMMAND:
                name = f"command.{instance.axis}" if instance.axis else "voltage"
                if name not in found:
                    found[name] = CommandInput(name, port.unit, [len(wiring.w) + len(found)])
                io[wiring.table[row, IO_OFFSET] + number] = found[name].places[0]
    return [*found.values()], io


def _rows(board: Board, io: IntArray) -> list[int]:
    """Return the rows of the part: all that run and their faults, and the reference only where one of them reads it.

    Raises
    ------
    InputError
        When one of them reads a block that no FMU has.
    """
    wiring = board.wiring
    aside = ("reference", "model")
    writers: dict[int, int] = {}
    for row, instance in enumerate(wiring.instances):
        start = int(wiring.table[row, IO_OFFSET]) + len(instance.block.inputs)
        for place in wiring.ports(row)[start - int(wiring.table[row, IO_OFFSET]) :].tolist():
            writers[place] = row
    kept = {
        row
        for row in range(len(wiring.instances))
        if wiring.instances[row].key.startswith("faults.") or (row in board.walk.running and not _is_aside(board, row))
    }
    chosen = {row for row in kept if wiring.instances[row].key not in aside}
    waiting = [*chosen]
    while waiting:
        row = waiting.pop()
        instance = wiring.instances[row]
        start = int(wiring.table[row, IO_OFFSET])
        for place in io[start : start + len(instance.block.inputs)].tolist():
            source = writers.get(place)
            if source is None or source in chosen:
                continue
            if source not in kept:
                if source in board.walk.running:
                    text = f"{instance.key} reads {wiring.instances[source].key}, which no FMU has"
                    raise InputError(f"{board.spec.device.id} cannot be an FMU: {text}", "scenario")
                continue  # a block that rests: its signals stay 0
            chosen.add(source)
            waiting.append(source)
    return sorted(chosen)


def _is_aside(board: Board, row: int) -> bool:
    instance = board.wiring.instances[row]
    family = instance.block.family
    return family in LEFT_OUT or instance.key.endswith(".score") or ".weighted" in instance.key


def table(one: FmuLayout) -> IntArray:
    """Return the offsets and the interval of each row."""
    found: IntArray = one.board.wiring.table[one.rows][:, [P_OFFSET, S_OFFSET, IO_OFFSET, EVERY]]
    return found
