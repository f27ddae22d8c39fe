"""The adaptive loop against python-control, in continuous time, and how much faster the board is."""

from __future__ import annotations

import numpy as np
import pytest

from core import registry
from core.board.board import CHUNK, Board
from scenarios.library import get
from scenarios.speed.boards import ADAPTIVE, GAIN
from scenarios.speed.gyroscope import ALIVE, ONE, running
from scenarios.speed.interconnected import adaptive_loop, simulate
from scenarios.speed.peers import interconnected_sample
from scenarios.speed.timing import advance_cost, block_costs, loop_cost
from tests.lab import inject, make, play

pytest.importorskip("control")


@pytest.mark.parametrize("rate_khz", [500, pytest.param(1000, marks=pytest.mark.long)])
def test_mrac_is_what_python_control_simulates(rate_khz):
    """A board that samples and holds differs by half a sample of delay: 0.5 w0 dt of what moves."""
    board = make({"controller": {"kind": "mrac"}, "sample_rate_khz": rate_khz})
    inject(board, stiffness=1.0)
    trace = play(board, 3 * rate_khz + 1)
    found = simulate(adaptive_loop(board.spec.context(), 2.0), 3.0, 3 * rate_khz + 1)
    delay = 0.5 * 15.606 / rate_khz
    assert np.abs(found.outputs[0] - trace["plant.displacement"]).max() < delay
    assert np.abs(found.outputs[1] - trace["model.displacement"]).max() < delay
    gains = np.array([trace[f"mrac.gain.{name}"][-1] for name in ("r", "w1", "w2", "y")])
    np.testing.assert_allclose(found.states[-5:-1, -1], gains, atol=delay)
    assert np.abs(gains - [1, 0, 0, 0]).max() > 0.2


@pytest.mark.long
def test_board_is_much_faster_than_the_interconnected_simulation():
    board = Board(ADAPTIVE)
    board.advance(CHUNK)
    peer = interconnected_sample(board)()
    assert peer > 700 * loop_cost(board, ["plant", "effects", "sensor", "reference", "model", "mrac", "drive"])
    # even with everything else on the board
    assert peer > 100 * advance_cost(board, 10 * CHUNK)


@pytest.mark.long
def test_every_controller_has_its_price():
    costs = {}
    for document in (ADAPTIVE, GAIN):
        board = Board(document)
        board.advance(CHUNK)
        for name in board.spec.controllers:
            costs |= block_costs(board, name)
    for bench in (ONE, get("ch6-mode-matching").spec):
        board = running(bench)
        alive = [one.key for one in board.wiring.instances if one.key in ALIVE]
        for name in board.spec.controllers:
            costs |= block_costs(board, name, alive=alive)
    assert set(costs) == set(registry.blocks("control"))
    assert np.isfinite(list(costs.values())).all()
