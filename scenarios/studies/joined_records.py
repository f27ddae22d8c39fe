"""Two steady records joined, as the experiments of chapter 5 were made."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from core.block import BlockParams, FloatArray, parameter
from core.board import fold, program, steps
from core.diagnose.hypothesis import hypotheses_of
from core.errors import InputError
from core.ports import TICK, TIME_MS
from scenarios.studies.monte_carlo import again
from scenarios.studies.study import Study

if TYPE_CHECKING:
    from core.board.board import Board

RECORDED = ("sensor.displacement", "drive.voltage", "drive.middle", "drive.end")
"""Signals that a diagnoser reads."""
HELD = 20
"""Samples in a row that count as a conclusion."""


class JoinedRecords(Study):
    """Records the bench without and with its events, both in their steady state, and plays one after the other.

    A joined record is easier than a device that changes: the second filter is in its own steady state already when
    its part begins. ``joined.<id>.t50`` is the number of samples from the joint until the probability of the second
    hypothesis stays above one half for 20 samples, or the length of the second part if it never does.
    """

    title = "Joined records"

    class Params(BlockParams):
        """Lengths."""

        first_samples: int = parameter(1886, "samples of the first record", equation="5.2.4.2", ge=10, le=1_000_000)
        second_samples: int = parameter(2314, "samples of the second record", ge=10, le=1_000_000)
        settle_samples: int = parameter(2000, "samples before each record", ge=0, le=1_000_000)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the number of samples until each diagnoser believes the second record."""
        if not board.spec.diagnosers:
            raise InputError("needs a diagnoser", "diagnosers")
        before = _record(board, params.settle_samples + params.first_samples, faulty=False)
        after = _record(board, params.settle_samples + params.first_samples + params.second_samples, faulty=True)
        joint = params.settle_samples + params.first_samples
        joined = {name: np.concatenate([before[name][params.settle_samples :], after[name][joint:]]) for name in before}
        results: dict[str, float] = {}
        for name, section in board.spec.diagnosers.items():
            hypotheses = hypotheses_of(section.params)
            if len(hypotheses) != 2:
                raise InputError("needs two hypotheses, one for each record", f"diagnosers.{name}.hypotheses")
            believed = _play(board, name, hypotheses[1].name, joined)[params.first_samples :] > 0.5
            runs = np.convolve(believed, np.ones(HELD), "valid") == HELD
            results[f"joined.{name}.t50"] = float(np.argmax(runs)) if runs.any() else float(params.second_samples)
        return results


def _record(board: Board, samples: int, *, faulty: bool) -> dict[str, FloatArray]:
    """Run the bench with all its events from the first sample on, or without any."""
    fresh = again(board, board.spec.seed)
    fresh.pending.at_once()
    if not faulty:
        fresh.pending.clear()
    record: dict[str, list[float]] = {name: [] for name in RECORDED}
    while fresh.tick < samples and fresh.advance(1).count:
        for name in RECORDED:
            record[name].append(fresh.value(name))
    return {name: np.array(values) for name, values in record.items()}


def _play(board: Board, name: str, hypothesis: str, record: dict[str, FloatArray]) -> FloatArray:
    """Run one diagnoser on a record and return the probability of a hypothesis."""
    wiring = again(board, board.spec.seed).wiring
    table = np.ascontiguousarray(wiring.table[[wiring.row(name)]])
    table[:, program.ADDRESS] = steps.address(wiring, wiring.row(name))
    nothing, watches = np.zeros((1, 0)), np.zeros((0, 3))
    places = {signal: wiring.index[signal] for signal in RECORDED}
    wanted, trip = wiring.index[f"{name}.probability.{hypothesis}"], wiring.index["guard.trip"]
    probability = np.empty(len(record["sensor.displacement"]))
    dt = board.dt_ms
    for tick in range(len(probability)):
        wiring.w[TICK], wiring.w[TIME_MS] = tick, tick * dt
        # the voltage of a sample is the voltage applied at the sample before
        wiring.w[places["sensor.displacement"]] = record["sensor.displacement"][tick]
        arrays = (table, wiring.p, wiring.s, wiring.w, wiring.io)
        program.run(1, tick, dt, *arrays, nothing, nothing, fold.begin(0), trip, watches)
        for signal in RECORDED[1:]:
            wiring.w[places[signal]] = record[signal][tick]
        probability[tick] = wiring.w[wanted]
    return probability
