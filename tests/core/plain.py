"""The oracle of the compiled loop: everything as plain Python, run with NUMBA_DISABLE_JIT=1.

Reads a list of cases from standard input and writes, for each, the digest of its trace. With ``fence`` every step
runs on arrays that know what the block may touch.
"""

from __future__ import annotations

import json
import sys
import warnings
from typing import Any

import numpy as np

from core.board import program
from core.board.spec import parse
from core.board.wiring import signal_name, wire
from core.faults.fault import Fault
from core.ports import TICK, TIME_MS
from core.registry import block
from tests.lab import make, run_digest


class Fence:
    """An array that refuses to be touched where the block has no business."""

    def __init__(self, what: str, array: np.ndarray, readable: set[int], writable: set[int]) -> None:
        self.what, self.array, self.readable, self.writable = what, array, readable, writable
        self.written: set[int] = set()

    def _place(self, index: Any, allowed: set[int], verb: str) -> int:
        if isinstance(index, bool) or not isinstance(index, int | np.integer):
            raise TypeError(f"{self.what}[{index!r}]: not an index")
        if int(index) not in allowed:
            raise IndexError(f"{verb} {self.what}[{int(index)}], allowed: {sorted(allowed)}")
        return int(index)

    def __getitem__(self, index: Any) -> Any:
        return self.array[self._place(index, self.readable, "reads")]

    def __setitem__(self, index: Any, value: Any) -> None:
        place = self._place(index, self.writable, "writes")
        self.written.add(place)
        self.array[place] = value


def fenced(case: dict[str, Any], ticks: int) -> None:
    """Run a bench with every step behind fences; complain about the first that climbs over."""
    spec = parse(case["document"])
    faults = {
        name: block("faults", name).Params(severity=severity, profile=profile, start_tick=5)
        for name, severity, profile in case["faults"]
    }
    wiring = wire(spec, faults)
    by_place: dict[int, str] = {}
    for name, place in wiring.index.items():
        # of a vector and its first component, the vector
        if place not in by_place or len(name) < len(by_place[place]):
            by_place[place] = name
    behind = []
    for row, instance in enumerate(wiring.instances):
        parts = []
        for column, array in (
            (program.P_OFFSET, wiring.p),
            (program.S_OFFSET, wiring.s),
            (program.IO_OFFSET, wiring.io),
        ):
            end = wiring.table[row + 1, column] if row + 1 < len(wiring.instances) else len(array)
            parts.append(array[wiring.table[row, column] : end])
        p, s, io = parts
        entry = instance.block
        inputs = io[: len(entry.inputs)]
        own_names = [signal_name(instance, port.name) for port in (*entry.outputs, *entry.taps)]
        own: set[int] = set()
        for name in own_names:
            own |= {place for signal, place in wiring.index.items() if signal == name or signal.startswith(f"{name}.")}
        assert len(io) == len(entry.inputs) + len(own_names), instance.key
        reads = {TICK, TIME_MS} | own
        for place in inputs:
            name = by_place[int(place)]
            reads |= {at for signal, at in wiring.index.items() if signal == name or signal.startswith(f"{name}.")}
        writes = set(own)
        if issubclass(entry, Fault):
            writes |= {int(place) for place in inputs}
        fences = (
            Fence("p", p, set(range(len(p))), set()),
            Fence("s", s, set(range(len(s))), set(range(len(s)))),
            Fence("w", wiring.w, reads, writes),
            Fence("io", io, set(range(len(io))), set()),
        )
        behind.append((instance, own, fences))
    for tick in range(ticks):
        wiring.w[TICK], wiring.w[TIME_MS] = tick, tick * spec.dt_ms
        for instance, _, fences in behind:
            if tick % instance.every == 0:
                try:
                    instance.block.step(*fences)
                except (IndexError, TypeError) as error:
                    raise SystemExit(f"{instance.key} at tick {tick}: {error}") from None
    for instance, own, fences in behind:
        missing = [by_place[place] for place in own - fences[2].written]
        if missing:
            raise SystemExit(f"{instance.key} never writes {missing}")


def main() -> None:
    """Answer on standard output."""
    import numba

    assert numba.config.DISABLE_JIT, "run with NUMBA_DISABLE_JIT=1"
    warnings.simplefilter("ignore")  # 64-bit counters overflow by design
    asked = json.load(sys.stdin)
    digests = []
    for case in asked["cases"]:
        if asked["fence"]:
            fenced(case, asked["ticks"])
        else:
            board = make(base=case["document"], commands=case["commands"], compiled=False)
            digests.append(run_digest(board, asked["ticks"]))
    json.dump(digests, sys.stdout)


if __name__ == "__main__":
    main()
