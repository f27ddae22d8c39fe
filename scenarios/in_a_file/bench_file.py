"""A live bench for a page without a server: its code, and the document with its numbers."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from core.board import fold, lost
from core.board.board import Board
from core.board.condition import parse_condition
from core.board.history import History
from core.board.instances import Instance, scored
from core.board.kept import CHANGED
from core.board.observer import warnings
from core.board.program import ADDRESS, TRIPPED, WATCHED
from core.board.pyramid import LANES, WIDEST
from core.board.spec import Section
from core.compile.numbers import Unsupported
from core.diagnose.consistency import AMBIGUOUS, ISOLATED, VERDICTS
from core.diagnose.hypothesis import names_of
from core.diagnose.regions import REGIONS
from core.errors import InputError
from core.loop.guard import REASONS
from core.ports import RESERVED
from core.wasm.module import module_of
from scenarios.in_a_file.kernels import KERNELS
from scenarios.in_a_file.writes import Writes, described
from scenarios.run import build
from scenarios.schema import Scenario

HISTORY_MB = 48.0
MOST_TICKS = 400_000
"""Of the past: the last 4 s at 100 kHz, where the memory has room for so many."""
BEFORE_THE_START = ("scheduled", "warning")
"""Entries of the log about waiting commands, and warnings of the scenario itself."""
ABSENT = "The narrator, classes, campaigns, recordings, the 3D view and hidden faults need the server."


@dataclass(frozen=True)
class BenchFile:
    """A bench in WebAssembly, its document, and the commands it has not, each with the reason."""

    code: bytes = field(repr=False)
    document: dict[str, Any] = field(repr=False)
    left_out: list[str]


def refusal(scenario: Scenario) -> str:
    """Return why a scenario cannot be a bench in a file; nothing if it can."""
    spec = scenario.spec
    reasons = {
        "it is a study, a computation without a bench": scenario.study,
        "it has twins, and a file has one board": scenario.twins,
        "it has a supervisor, whose acts are computed in Python": spec.supervisors,
        "its plant is a record, which is no part of a file": spec.record is not None,
        "it has a unit in a text, which is compiled on a server": spec.library.units,
    }
    return next((text for text, holds in reasons.items() if holds), "")


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
    blocks = [*dict.fromkeys(one.block for one in board.wiring.instances)]
    try:
        code = module_of(KERNELS, blocks)
    except Unsupported as error:
        raise InputError(f"{scenario.id} cannot be a bench in a file: {error}", "scenario") from None
    writes = Writes(board, scenario)
    faults, wirings, values = writes.faults(), writes.wirings(), writes.values()
    document = {
        "id": scenario.id,
        "title": scenario.head.title or scenario.id,
        "summary": scenario.head.summary,
        "absent": ABSENT,
        "dt_ms": board.dt_ms,
        "seed": board.spec.frame.seed,
        **_arrays(board, blocks),
        **_signals(board),
        **_trips(board),
        "followed": _followed(board),
        "diagnosers": {name: _diagnoser(section) for name, section in board.diagnosers.items()},
        "scores": {name: _score(board, name) for name, section in board.diagnosers.items() if scored(section.block)},
        "faults": faults,
        "present": writes.present(faults),
        "wirings": wirings,
        "values": values,
        "sensors": {"all": list(board.spec.sensors), "measuring": board.spec.measuring},
        "controllers": {name: section.block.title for name, section in board.spec.controllers.items()},
        "events": _events(board, faults),
        "log": [entry.model_dump(exclude={"seq"}) for entry in board.log if entry.kind not in BEFORE_THE_START],
    }
    return BenchFile(code, document, writes.left_out)


def _arrays(board: Board, blocks: list[Any]) -> dict[str, Any]:
    """Return the arrays of a board; the address of a step is its number."""
    wiring = board.wiring
    table = wiring.table.copy()
    table[:, ADDRESS] = [blocks.index(one.block) for one in wiring.instances]
    outputs, taps = wiring.signals.outputs, len(wiring.signals.taps)
    history = History(outputs, taps, min(MOST_TICKS, History.ticks_within(HISTORY_MB, outputs, taps)))
    groups, lanes = history.places(np.arange(outputs + taps))
    ring, low, _, offsets, sizes = history.rings
    return {
        "arrays": {"table": table, "p": wiring.p, "s": wiring.s, "w": wiring.w, "io": wiring.io},
        "running": board.walk.running,
        "rows": [_row(board, row, one) for row, one in enumerate(wiring.instances)],
        "endless": np.flatnonzero(wiring.endless),
        "folds": fold.begin(outputs),
        "fold": fold.START[:, 0],
        "history": {
            "lanes": LANES,
            "widest": WIDEST,
            "capacity": history.capacity,
            "offsets": offsets,
            "sizes": sizes,
            "groups": groups,
            "places": lanes,
            "ring": list(ring.shape),
            "buckets": list(low.shape),
        },
        "look_every": lost.EVERY,
        "reasons": {"tripped": TRIPPED, "watched": WATCHED, "changed": CHANGED},
    }


def _row(board: Board, row: int, instance: Instance) -> dict[str, Any]:
    """Return where the numbers of a block are, and the block's name."""
    wiring = board.wiring
    _, p, s, _, _ = wiring.table[row].tolist()
    return {
        "key": instance.key,
        "prefix": instance.prefix,
        "p": [p, p + len(wiring.packed(row))],
        "s": [s, s + len(wiring.state_of(instance.key))],
        "w": wiring.signals_of_row(row).tolist(),
    }


def _signals(board: Board) -> dict[str, Any]:
    signals = board.wiring.signals
    return {
        "outputs": signals.outputs,
        "reserved": RESERVED,
        "signals": [{"name": one.name, "unit": one.unit, "meaning": one.meaning} for one in signals],
        "blocks": list(signals.output_blocks),
    }


def _trips(board: Board) -> dict[str, Any]:
    """Return the places of the trips of all guards, their reasons, and the places that a trip sets to 0."""
    wiring, spec = board.wiring, board.spec
    disengaged = [
        wiring.index[f"{one.prefix}.{port.name}"]
        for one in wiring.instances
        if one.prefix.split(".")[0] in ("drive", "amplifier")
        for port in one.block.outputs
    ]
    guards = [f"guard.{axis}" for axis in spec.axes] or ["guard"]
    return {
        "trip": wiring.trip,
        "guards": [wiring.index[f"{one}.trip"] for one in guards],
        "trip_reasons": {str(code): text.format(signal=signal) for code, (text, signal) in REASONS.items()},
        "disengaged": disengaged,
    }


def _followed(board: Board) -> dict[str, Any]:
    """Return the signals whose changes become findings, in the order of their columns, with their words."""
    signals = board.wiring.signals
    known = {*signals.names}
    found: dict[int, dict[str, Any]] = {}
    for name, section in board.diagnosers.items():
        labels = names_of(section.params) if scored(section.block) else []
        if labels:
            found[signals.index(f"{name}.truth")] = {"kind": "truth", "diagnoser": name}
            found[signals.index(f"{name}.delay")] = {"kind": "delay", "diagnoser": name}
        words = {"verdict": VERDICTS, "region": REGIONS, "alarm": ("alarm over", "alarm")}
        words["unexcited"] = (
            "the drive tells them apart again",
            "the drive hardly tells the likeliest two apart",
        )
        for port, texts in words.items():
            if f"{name}.{port}" in known:
                entry: dict[str, Any] = {"kind": port, "diagnoser": name, "words": list(texts)}
                if port == "verdict":
                    entry["left"] = [int(ISOLATED), int(AMBIGUOUS)]
                    entry["columns"] = [signals.index(f"{name}.consistent.{label}") for label in labels]
                found[signals.index(f"{name}.{port}")] = entry
    for name, text in warnings(board.wiring).items():
        found[signals.index(name)] = {"kind": "warning", "text": text}
    columns, last = board.observer.followed
    return {"columns": columns, "last": last, "told": [found[column] for column in columns.tolist()]}


def _diagnoser(section: Section) -> dict[str, Any]:
    hypotheses = getattr(section.params, "hypotheses", ())
    return {
        "kind": section.block.name,
        "title": section.block.title,
        "scored": scored(section.block),
        "names": [one.name for one in hypotheses],
        "factors": [one.model_dump(exclude_defaults=True, exclude={"name"}) for one in hypotheses],
    }


def _score(board: Board, name: str) -> dict[str, Any]:
    """Return where the score of a diagnoser is: its row, the places of its counters, and its two signals."""
    wiring = board.wiring
    layout = type(wiring.state(f"{name}.score")).layout
    return {
        "row": wiring.row(f"{name}.score"),
        "names": names_of(board.diagnosers[name].params),
        "places": {field.name: layout.size if field.tail else field.offset for field in layout.fields},
        "kept": {field.name: field.count for field in layout.fields if field.count},
        "winner": wiring.index[f"{name}.winner"],
        "unexplained": wiring.index[f"{name}.unexplained"],
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
