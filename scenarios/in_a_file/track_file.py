"""A track of the benchmark as a page: its public cases, each with its own device, and the published rows.

The cases of a track differ in their numbers alone. A page has the board of one case, and for the others the numbers
that differ. Diagnosers share most of these numbers, which are kept once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from core.board.commands import Inject
from core.board.library import library_of
from core.board.program import ADDRESS
from core.wasm.module import module_of
from scenarios.benchmark.answer import said_by, section
from scenarios.benchmark.results import kept
from scenarios.benchmark.seeds import seed_list
from scenarios.benchmark.track import BenchmarkTrack, Case, tracks
from scenarios.in_a_file.bench_file import BenchFile
from scenarios.in_a_file.board_file import board_document
from scenarios.in_a_file.board_steps import Step, steps_of
from scenarios.in_a_file.board_writes import BoardWrites
from scenarios.in_a_file.kernels import KERNELS
from scenarios.run import build

SEEDS = "public"
NUMBERS = ("p", "s", "w")
"""Arrays of a board in which cases differ."""
PAST_TICKS = 1
"""Nothing is drawn, so no past is kept but the least."""


@dataclass(frozen=True)
class CaseNumbers:
    """The numbers with which a case begins, its faults, and the kind of its board."""

    kind: bytes
    arrays: dict[str, FloatArray]
    document: dict[str, Any]


def track_file(name: str) -> BenchFile:
    """Return the public cases of a track, with all diagnosers of its published rows side by side."""
    track = tracks()[name]
    rows = kept().ranked(name)
    blocks = {row.unit: library_of({}).block("diagnose", row.unit, "UNIT") for row in rows}
    sections = {unit: section(block, track) for unit, block in blocks.items()}
    cases: list[CaseNumbers] = []
    firsts: dict[bytes, Board] = {}
    for seed in seed_list(SEEDS, tuple(tracks())).cases[name]:
        case = track.case(seed)
        board = build(case.scenario(sections, {}), compiled=False)
        numbers = _numbers(case, board)
        cases.append(numbers)
        firsts.setdefault(numbers.kind, board)
    steps = steps_of(firsts.values())
    document = {
        "title": f"{track.title}: {len(cases)} cases of mems-diag-1",
        "summary": track.question,
        "track": {
            "note": track.note,
            "samples": sum(one.document["samples"] for one in cases),
            "groups": [
                {
                    "document": {"id": name, **_board(board, steps), "events": [], "done": [], "twins": {}},
                    "said": {unit: _columns(board, track, unit) for unit in blocks},
                    **differences([one for one in cases if one.kind == kind]),
                }
                for kind, board in firsts.items()
            ],
            "cases": [{"group": [*firsts].index(one.kind), **one.document} for one in cases],
            "rows": [
                {
                    "unit": row.unit,
                    "title": blocks[row.unit].title,
                    "log_score": None if row.log_score is None else row.log_score.mean,
                    "digest": row.digest,
                }
                for row in rows
            ],
        },
    }
    return BenchFile(module_of(KERNELS, steps), document, [])


def _numbers(case: Case, board: Board) -> CaseNumbers:
    wiring, writes = board.wiring, BoardWrites(board)
    table = wiring.table.copy()
    table[:, ADDRESS] = 0
    names = ",".join(one.block.name for one in wiring.instances)
    kind = b"".join([names.encode(), table.tobytes(), wiring.io.tobytes(), repr(board.walk.running).encode()])
    faults: list[dict[str, Any]] = []
    events: list[dict[str, Any]] = []
    for entry in board.pending.as_asked:
        command = entry.command
        assert isinstance(command, Inject) and entry.tick is not None
        place = writes.fault(command.fault, command)
        faults.append({"name": command.fault, **place, "packed": writes.packed(place["row"], command)})
        events.append({"tick": entry.tick, "command": {"fault": command.fault, "severity": command.severity}})
    document = {"seed": case.seed, "samples": case.document["samples"], "faults": faults, "events": events}
    return CaseNumbers(kind, {name: getattr(wiring, name).copy() for name in NUMBERS}, document)


def _board(board: Board, steps: list[Step]) -> dict[str, Any]:
    """Return the document of a board without commands."""
    writes = {
        "faults": {},
        "present": {},
        "wirings": {"slots": {}, "driving": dict(board.spec.driving), "writes": {}},
        "values": {},
        "supervisor": None,
    }
    return board_document(board, steps, writes, PAST_TICKS)


def _columns(board: Board, track: BenchmarkTrack, unit: str) -> list[int]:
    """Return the signals of a diagnoser whose bits the digest of its row is of."""
    block = board.spec.diagnosers[unit].block
    return [board.wiring.signals.index(name) for name in said_by(track, unit, block)]


def differences(cases: list[CaseNumbers]) -> dict[str, Any]:
    """Return the places at which cases differ, the number of each place, and these numbers for each case."""
    stacked = {name: np.stack([one.arrays[name] for one in cases]).view(np.int64) for name in NUMBERS}
    places = {name: np.flatnonzero(np.any(bits != bits[0], axis=0)) for name, bits in stacked.items()}
    differing = np.hstack([stacked[name][:, places[name]] for name in NUMBERS])
    unlike, which = np.unique(differing, axis=1, return_inverse=True)
    parts = np.split(which.ravel(), np.cumsum([len(places[name]) for name in NUMBERS])[:-1])
    return {
        "differs": {name: {"places": places[name], "which": part} for name, part in zip(NUMBERS, parts, strict=True)},
        "numbers": np.ascontiguousarray(unlike.T).view(np.float64),
    }
