"""The table of the anchor: the cost of a tick on a board and in C, and their ratio."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from core.board.board import Board
from core.compile.segment import code_of
from scenarios.library import get
from scenarios.run import build
from scenarios.speed import boards
from scenarios.speed.anchor.compiler import compiler, libraries, version
from scenarios.speed.anchor.pair import OURS, AdvancePair, C, LivePair, StepsPair, TwinPair
from scenarios.speed.anchor.replay import ReplayInC
from scenarios.speed.anchor.text import BoardMoment, board_text
from scenarios.speed.figure import ratio
from scenarios.speed.timing import interleaved

BENCHES: dict[str, Callable[[], Board]] = {
    "everything": lambda: boards.seven_step_bench(boards.EVERYTHING),
    "first-look": lambda: build(get("first-look")),
    "seven steps": boards.with_all_diagnosers,
}
"""The last is the bench of the run, with all six diagnosers."""
PAIRS: tuple[type[TwinPair], ...] = StepsPair, AdvancePair, LivePair
ROUNDS = 9
RUN = "seven steps"


@dataclass(frozen=True)
class AnchorRow:
    """One line of the table: the costs of each round, ns, and the parts in which board and C differ."""

    bench: str
    part: str
    goal: float
    costs: dict[str, list[float]]
    differences: list[str]

    def document(self) -> dict[str, Any]:
        """Return the line, JSON-ready: medians and lower quartiles."""
        found: dict[str, Any] = {"bench": self.bench, "part": self.part, "rounds": len(self.costs[OURS])}
        for name, values in self.costs.items():
            found |= {f"{name}_ns": median(values), f"{name}_lower_quartile_ns": _lower(values)}
        if C not in self.costs:
            return found | {"ok": True}
        value = median(ratio(self.costs, OURS, C))
        return found | {
            "ratio": value,
            "ratio_of_lower_quartiles": _lower(self.costs[OURS]) / _lower(self.costs[C]),
            "goal": self.goal,
            "differences": self.differences,
            "ok": value <= self.goal and not self.differences,
        }


def _lower(values: list[float]) -> float:
    return float(np.quantile(values, 0.25))


def fused(board: Board) -> Board:
    """Return a copy of a board that runs each segment of a tick as one function."""
    copy = Board.restore(board.checkpoint())
    copy.fuse()
    for segment in copy.unfused:
        segment.load(code_of(segment.steps))
    return copy


class Anchor:
    """The boards, their C where the machine has a compiler, and the lines of the table."""

    def __init__(self, rounds: int = ROUNDS) -> None:
        self._rounds, self.compiler, self.missing = rounds, "", ""

    def rows(self) -> Iterator[AnchorRow]:
        """Measure line by line: a board and its C in turn on the same ticks."""
        made, replay = {name: make() for name, make in BENCHES.items()}, ReplayInC()
        texts = {name: lambda board=board: board_text([BoardMoment.of(board)]) for name, board in made.items()}
        made_in_c = self._in_c({**texts, "run": lambda: board_text(replay.moments)})
        for name, board in made.items():
            for form, one in {"": board, ", fused": fused(board)}.items():
                for kind in PAIRS:
                    yield self._row(name, kind(one, made_in_c.get(name)), form)
        replay.library = made_in_c.get("run")
        yield self._row(RUN, replay)

    def _row(self, bench: str, pair: TwinPair | ReplayInC, form: str = "") -> AnchorRow:
        costs = interleaved(pair.costs(), self._rounds)
        return AnchorRow(bench, pair.part + form, pair.goal, costs, [*pair.differences()])

    def _in_c(self, texts: dict[str, Callable[[], str]]) -> dict[str, Any]:
        path = compiler()
        if path is None:
            self.missing = "nothing is measured against C: there is no gcc on this machine"
            return {}
        self.compiler = version(path)
        with tempfile.TemporaryDirectory() as folder:
            try:
                return libraries(path, {name: text() for name, text in texts.items()}, Path(folder))
            except RuntimeError as error:
                self.missing = f"nothing is measured against C: {error}"
                return {}
