"""Runs benches in one of the ways that the project has: ``python -m tests.scenarios.ways LEVEL WAY``.

The level names the processor that code is for (``native`` is this one). The way is ``plain`` (uncompiled), ``1`` (a
board alone), ``8`` or ``16`` (boards side by side, of which the second is the bench, the others have other seeds), or
``wall`` (every step as WebAssembly). Standard input has the scenarios, a JSON list; the output has a result of each.
"""

from __future__ import annotations

import atexit
import hashlib
import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from functools import cache
from typing import Any

import pytest

from core.compile import machine
from tests.library_pass import ROOT

LEVELS = {level.processor: level for level in machine.LEVELS} | {"native": machine.native()}
PLAIN, ALONE, WALL = "plain", "1", "wall"
MOST_CROSSINGS = 1000
"""Steps of benches behind the wall that are kept for the next bench."""
Result = dict[str, Any]
"""The digest of a run; ``inner``, a hash of all states and signals at its end, unless boards ran side by side."""


def results(scenarios: Sequence[dict[str, Any]], way: str, level: str = "native") -> list[Result]:
    """Return the results of scenarios, from a process of its own; an empty one where boards cannot be side by side."""
    command = [sys.executable, "-W", "ignore", "-m", "tests.scenarios.ways", level, way]
    told = subprocess.run(command, cwd=ROOT, input=json.dumps(scenarios), capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    found: list[Result] = json.loads(told.stdout)
    return found


def result(document: dict[str, Any], way: str) -> Result:
    """Return the result of a scenario, from this process."""
    from scenarios.schema import Scenario

    scenario = Scenario.load(document)
    if way not in (PLAIN, ALONE, WALL):
        return _abreast(scenario)
    from scenarios.run import DEFAULT_SAMPLES, build

    samples = scenario.samples or DEFAULT_SAMPLES
    with _behind_the_wall() if way == WALL else nullcontext():
        board = build(scenario, compiled=way != PLAIN)
        while board.tick < samples and board.advance(samples - board.tick).count:
            pass
    arrays = [array for one in (board, *getattr(board, "twins", {}).values()) for array in (one.wiring.s, one.wiring.w)]
    inner = hashlib.sha256(b"".join(array.tobytes() for array in arrays)).hexdigest()
    return {"digest": board.digest(), "inner": inner, "trip": board.trip and board.trip.reason}


def _abreast(scenario: Any) -> Result:
    from core.board.abreast import Abreast
    from core.board.lane_traces import LaneTraces
    from core.board.pattern import Pattern, Uneven
    from scenarios.run import build

    if scenario.twins:
        return {}
    seed = scenario.spec.seed
    boards = [build(scenario, one) for one in (seed + 1, seed, seed + 2)]
    try:
        pattern = Pattern(boards[0])
        queues = [board.pending for board in boards]
        traces = LaneTraces(pattern.board.wiring, [], scenario.samples)
        lanes = Abreast(pattern, [board.spec for board in boards], queues, traces)
        came = lanes.run(scenario.samples)
    except Uneven:
        return {}
    return {"digest": lanes.boards[1].digest()} if came[1] else {}


@contextmanager
def _behind_the_wall() -> Iterator[None]:
    """Let every step of boards that are built now run behind the wall, not units of one's own alone."""
    from core.board import steps
    from core.ports import INPUT
    from core.wall import wall
    from core.wall.crossing import PortSignal, Sizes

    def address(wiring: Any, row: int, width: int = 1) -> int:
        instance = wiring.instances[row]
        behind = []
        for port, place in zip(instance.block.Ports.declared, wiring.ports(row), strict=True):
            name = min((name for name, at in wiring.index.items() if at == place), key=len)
            size = 1 + sum(bool(one.startswith(f"{name}.") and at != place) for one, at in wiring.index.items())
            behind.append(PortSignal(name, size, port.kind != INPUT or port.source.startswith("effects.")))
        sizes = Sizes(len(wiring.packed(row)), len(wiring.state_of(instance.key)), tuple(behind))
        return wall.address(instance.block, sizes, width)

    if sum(map(len, wall._crossings.values())) > MOST_CROSSINGS:
        wall._crossings.clear()  # no board that was built before is left
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(steps, "address", address)
        patch.setattr(wall, "INSTANCES", 1)  # one thread runs them
        patch.setattr(wall, "module_of", _module_of)
        yield


@cache
def _module_of(code: bytes) -> Any:
    from core.wall.host import module_of

    return module_of(code)


atexit.register(_module_of.cache_clear)  # while the package that deletes them is loaded


def main() -> None:
    """Print the results."""
    level, way = sys.argv[1:]
    machine.native = lambda: LEVELS[level]  # before any module takes it from there
    machine.WIDTH = int(way) if way.isdigit() and way != ALONE else machine.WIDTH
    import scenarios  # noqa: F401  (first: it gives compiled kernels their cache)

    print(json.dumps([result(document, way) for document in json.load(sys.stdin)]))


if __name__ == "__main__":
    main()
