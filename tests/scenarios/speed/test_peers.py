"""The peers solve the same task as the board: their answers are alike."""

from __future__ import annotations

import numpy as np
import pytest

from core.board.board import Board
from core.device.response import held_response
from scenarios.speed import boards
from scenarios.speed.peers import solved
from tests.lab import play


def test_the_nonlinear_plant_is_what_scipy_solves():
    board = Board(boards.NONLINEAR)
    trace = play(board, 300)
    states = solved(board, 299, rtol=1e-9, atol=1e-12)
    assert np.abs(trace["plant.displacement"]).max() > 1.0
    np.testing.assert_allclose(trace["plant.displacement"], states[:, 0], atol=1e-6)
    np.testing.assert_allclose(trace["plant.velocity"], states[:, 1], atol=1e-4)


def test_the_record_of_the_linear_plant_is_what_python_control_simulates():
    control = pytest.importorskip("control")
    device = boards.begun(boards.ADAPTIVE).spec.context().device
    time = np.arange(2000) * 0.01
    # continuous, so that a held voltage and the straight lines of the peer are the same
    voltage = np.where(time > 1.0, 3.0, 3.0 * time)
    system = control.tf([device.force], [device.mass, device.damping, device.stiffness])
    peer = control.forced_response(system, time, voltage).outputs
    own = held_response(device, voltage, 0.01)
    # holding is half a sample late
    assert np.abs(own - peer).max() < 0.02 * np.abs(peer).max()
    np.testing.assert_allclose(own[-1], peer[-1], rtol=1e-4)
