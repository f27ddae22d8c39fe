"""A live bench for a page without a server: its code, and the document with its numbers."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from core.board.board import Board
from core.board.commands import SetValues, Switch
from core.board.condition import parse_condition
from core.board.ensemble import Ensemble, shown
from core.board.history import History
from core.board.spec import Spec
from core.compile.numbers import Unsupported
from core.device.catalogue import device
from core.errors import InputError
from core.wasm.module import module_of
from scenarios.in_a_file.board_file import board_document
from scenarios.in_a_file.board_steps import steps_of
from scenarios.in_a_file.board_writes import BoardWrites
from scenarios.in_a_file.kernels import KERNELS
from scenarios.in_a_file.supervisor_table import refused_supervisor
from scenarios.in_a_file.writes import MAIN, Writes, described
from scenarios.run import build
from scenarios.schema import Scenario

HISTORY_MB = 48.0
MOST_TICKS = 400_000
"""Of the past: the last 4 s at 100 kHz, where the memory has room for so many."""
STAND_IN = "lcr-350"
"""The device that is drawn where a device has no drawing."""
ABSENT = "The narrator, classes, campaigns, recordings, the 3D view and hidden faults need the server."


@dataclass(frozen=True)
class BenchFile:
    """A bench in WebAssembly, its document, and the commands it has not, each with the reason."""

    code: bytes = field(repr=False)
    document: dict[str, Any] = field(repr=False)
    left_out: list[str]


def refusal(scenario: Scenario) -> str:
    """Return why a scenario cannot be a bench in a file; nothing if it can."""
    specs = [scenario.spec, *scenario.twins.values()]
    reasons = {
        "it is a study, a computation without a bench": scenario.study,
        "its plant is a record, which is no part of a file": any(spec.record is not None for spec in specs),
        "it has a unit in a text, which is compiled on a server": any(spec.library.units for spec in specs),
    }
    found = [text for text, holds in reasons.items() if holds]
    return next(iter(found or filter(None, map(refused_supervisor, specs))), "")


def bench_file(scenario: Scenario) -> BenchFile:
    """Return a scenario as a bench for a page without a server.

    Raises
    ------
    InputError
        When it cannot be one, with the reason.
    """
    if reason := refusal(scenario):
        raise InputError(f"{scenario.id} cannot be a bench in a file: {reason}", "scenario")
    board = build(scenario, compiled=False)
    boards = {MAIN: board, **(board.twins if isinstance(board, Ensemble) else {})}
    steps = steps_of(boards.values())
    try:
        code = module_of(KERNELS, steps)
    except Unsupported as error:
        raise InputError(f"{scenario.id} cannot be a bench in a file: {error}", "scenario") from None
    writes = Writes(board, scenario)
    faults, wirings, values = writes.faults(), writes.wirings(), writes.values()
    present = writes.present(faults)
    ticks = _ticks([*boards.values()])
    found = {
        name: board_document(
            each,
            steps,
            {
                "faults": faults[name],
                "present": present[name],
                "wirings": wirings[name],
                "values": values[name],
                "supervisor": writes.supervisors[name],
            },
            ticks,
        )
        for name, each in boards.items()
    }
    document = {
        "id": scenario.id,
        "title": scenario.head.title or scenario.id,
        "summary": scenario.head.summary,
        "absent": ABSENT,
        "seed": board.spec.frame.seed,
        "plan": _plan(board.spec),
        **found.pop(MAIN),
        "events": _events(board, faults[MAIN]),
        "done": [[tick, described(command, faults[MAIN])] for tick, command in board.done],
        "twins": {
            name: {"shown": shown(boards[name]), **_kept(writes.boards[name], wirings, values), **twin}
            for name, twin in found.items()
        },
    }
    return BenchFile(code, document, writes.left_out)


def _plan(spec: Spec) -> dict[str, Any]:
    """Return the numbers of the drawing of the device, or of the device that is drawn in its place."""
    own = spec.device.geometry
    shown = None if spec.axes else own or device({"id": STAND_IN}).geometry
    return {"geometry": shown and shown.model_dump(), "is_stand_in": not spec.axes and own is None}


def _ticks(boards: list[Board]) -> int:
    """Return how many ticks of the past all boards keep."""
    tables = [board.wiring.signals for board in boards]
    share = HISTORY_MB / len(boards)
    return min(MOST_TICKS, *(History.ticks_within(share, one.outputs, len(one.taps)) for one in tables))


def _kept(twin: BoardWrites, wirings: dict[str, Any], values: dict[str, Any]) -> dict[str, Any]:
    """Return the controllers and values of the main board whose commands are not for a twin, which has its own."""
    return {
        "own_switches": [name for name in wirings[MAIN]["slots"] if twin.keeps_own(Switch(switch=name))],
        "own_values": [path for path in values[MAIN] if twin.keeps_own(SetValues(set={path: 0.0}))],
    }


def _events(board: Board, faults: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the events that wait, in the order in which events of one tick take effect."""
    found = []
    for entry in board.pending.as_asked:
        event: dict[str, Any] = {"tick": entry.tick, "command": described(entry.command, faults)}
        if entry.command.when is not None:
            condition = parse_condition(entry.command.when, board.wiring.signals.names)
            place = board.wiring.index[condition.signal]
            event["when"] = [place, condition.sign, condition.threshold]
        found.append(event)
    return found
