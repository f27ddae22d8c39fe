"""The seven steps of 5.2.4 over many seeds, several diagnosers side by side on the same samples."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from core.board.board import Board
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.schema import Scenario

LENGTHS = (2000, 1000, 1000, 1000, 1000, 1000, 2000)
EDGES = np.concatenate([[0], np.cumsum(LENGTHS)])
TRUTH = np.repeat([0, 1, 2, 3, 4, 5, 0], LENGTHS)
HELD_OUT = 70_000
"""First of the seeds no parameter was ever chosen on."""


@dataclass(frozen=True)
class Seen:
    """Means over seeds; ``delays`` and ``missed`` and ``right`` have one entry for each step."""

    correct: float
    false: float
    delays: np.ndarray
    missed: np.ndarray
    right: np.ndarray
    spread: float

    @property
    def later(self) -> float:
        """Mean delay of the steps after the first."""
        return float(self.delays[1:].mean())


def seven_steps(seeds: range, diagnosers: dict[str, dict[str, Any]], base: str = "ch5-seven-step", **values: Any):
    """Run the seven steps for each seed and score every diagnoser here, by the definitions of the tests."""
    changed = {path.replace("__", "."): value for path, value in values.items()}
    scenario = with_values(get(base), {"expect": [], "diagnosers": diagnosers, **changed})
    runs: dict[str, list[np.ndarray]] = {name: [] for name in diagnosers}
    for seed in seeds:
        winners = winners_of(scenario, seed, list(diagnosers))
        for name, winner in winners.items():
            runs[name].append(winner)
    return {name: judged(np.array(found)) for name, found in runs.items()}


def winners_of(scenario: Scenario, seed: int, names: list[str], samples: int = 9000) -> dict[str, np.ndarray]:
    """Return the likeliest hypothesis at every sample."""
    board = build(scenario, seed)
    columns = [board.signals.index(f"{name}.winner") for name in names]
    parts = [rows.outputs[:, columns].copy() for rows in chunks(board, samples)]
    return dict(zip(names, np.vstack(parts).T, strict=True))


def chunks(board: Board, samples: int):
    """Yield the rows of a board."""
    while board.tick < samples:
        rows = board.advance(samples - board.tick)
        assert rows.count, board.trip
        yield rows


def judged(winners: np.ndarray, held: int = 20) -> Seen:
    """Score winners (seeds by samples): right for 20 in a row counts as found, exits after that as false switches."""
    right = winners == TRUTH
    delays, missed = np.empty((len(right), 7)), np.zeros((len(right), 7), dtype=bool)
    false = np.zeros(len(right))
    for k, one in enumerate(right):
        for step, length in enumerate(LENGTHS):
            part = one[EDGES[step] : EDGES[step + 1]]
            sums = np.convolve(part, np.ones(held), "valid")
            found = np.flatnonzero(sums > held - 0.5)
            if not len(found):
                delays[k, step], missed[k, step] = length, True
                continue
            delays[k, step] = found[0]
            after = part[found[0] :]
            false[k] += np.sum(after[:-1] & ~after[1:])
    shares = np.array([right[:, EDGES[i] : EDGES[i + 1]].mean() for i in range(7)])
    return Seen(
        float(right.mean()),
        float(false.mean()),
        delays.mean(axis=0),
        missed.mean(axis=0),
        shares,
        float(right.mean(axis=1).std()),
    )
