"""The document of one board of a bench in a file: its arrays, signals, trips, and the commands to it."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.board import fold, lost
from core.board.board import Board
from core.board.history import History
from core.board.instances import Instance, scored
from core.board.kept import CHANGED
from core.board.observer import warnings
from core.board.program import ADDRESS, TRIPPED, WATCHED
from core.board.pyramid import LANES, WIDEST
from core.board.spec import Section
from core.diagnose.consistency import AMBIGUOUS, ISOLATED, VERDICTS
from core.diagnose.hypothesis import names_of
from core.diagnose.regions import REGIONS
from core.loop.guard import REASONS
from core.ports import RESERVED
from scenarios.in_a_file.board_steps import Step, segments_of

BEFORE_THE_START = ("scheduled", "warning")
"""Entries of the log about waiting commands, and warnings of the scenario itself."""


def board_document(board: Board, steps: list[Step], writes: dict[str, Any], ticks: int) -> dict[str, Any]:
    """Return the document of a board.

    Parameters
    ----------
    board : Board
        At its first tick.
    steps : list
        All blocks and segments of the bench; the number of a step is its place.
    writes : dict
        Faults, wirings and values.
    ticks : int
        Of its past.
    """
    return {
        "dt_ms": board.dt_ms,
        **_arrays(board, steps, ticks),
        **_signals(board),
        **_trips(board),
        "followed": _followed(board),
        "diagnosers": {name: _diagnoser(section) for name, section in board.spec.diagnosers.items()},
        "scores": {name: _score(board, name) for name, one in board.spec.diagnosers.items() if scored(one.block)},
        **writes,
        "sensors": {"all": list(board.spec.sensors), "measuring": board.spec.measuring},
        "controllers": {name: section.block.title for name, section in board.spec.controllers.items()},
        "log": [entry.model_dump(exclude={"seq"}) for entry in board.log if entry.kind not in BEFORE_THE_START],
    }


def _arrays(board: Board, steps: list[Step], ticks: int) -> dict[str, Any]:
    """Return the arrays of a board; the address of a step is its number."""
    wiring = board.wiring
    table = wiring.table.copy()
    table[:, ADDRESS] = [steps.index(one.block) for one in wiring.instances]
    outputs, taps = wiring.signals.outputs, len(wiring.signals.taps)
    history = History(outputs, taps, ticks)
    groups, lanes = history.places(np.arange(outputs + taps))
    ring, low, _, offsets, sizes = history.rings
    return {
        "arrays": {"table": table, "p": wiring.p, "s": wiring.s, "w": wiring.w, "io": wiring.io},
        "running": board.walk.running,
        "segments": segments_of(board, steps),
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
    for name, section in board.spec.diagnosers.items():
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
        "names": names_of(board.spec.diagnosers[name].params),
        "places": {field.name: layout.size if field.tail else field.offset for field in layout.fields},
        "kept": {field.name: field.count for field in layout.fields if field.count},
        "winner": wiring.index[f"{name}.winner"],
        "unexplained": wiring.index[f"{name}.unexplained"],
    }
