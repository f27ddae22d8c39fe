"""The voltage of a sample as identifiers are given it: what was applied in its middle."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.signal import cont2discrete

from tests.lab import make, play
from tests.physics.test_identify import bench


@pytest.mark.parametrize("every", [1, 4])
@pytest.mark.parametrize("drive", ["held", "analogue"])
def test_the_voltage_of_a_sample_is_its_mean_whatever_the_drive(drive, every):
    """Least squares over the tones in closed form; taken from its start, an analogue voltage is half a tick early."""
    tones, h = [0.5 * math.pi * k for k in (1, 2, 4, 8)], 0.01
    m, b, k, force = 2.209e-4, 7.09e-4, 0.0538, -4 * 24 * 8.8541878128e-12 * 20 / 1.05 * 1e6
    own = {"kind": "recursive_least_squares", "start": "zero", "forgetting": 1 - 5e-4 * every, "every": every}
    trace = play(bench(own, tones, {"plant.drive": drive}), 12_000)
    system = tuple(np.array(rows) for rows in ([[0, 1], [-k / m, -b / m]], [[0.0], [force / m]], [[1.0, 0]], [[0.0]]))
    a, g, c, *_ = cont2discrete(system, h)
    rows, right = [], []
    for w in tones:
        if drive == "held":
            y = (c @ np.linalg.solve(np.exp(1j * w * h) * np.eye(2) - a, g)).item()
        else:
            y = force / (k - m * w * w + 1j * b * w)
        seen = 0.0 if drive == "held" else 0.5  # of a tick
        u = np.mean(np.exp(1j * w * h * (np.arange(-every, 0) + seen)))
        late = np.exp(-1j * w * h * every)
        for part in (np.real, np.imag):
            rows.append([part(u), part(u * late), part(-y * late), part(-y * late * late)])
            right.append(part(y))
    theory = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
    found = [trace[f"x.coefficient.{name}"][-1] for name in ("b0", "b1", "a1", "a2")]
    np.testing.assert_allclose(found, theory, rtol=2e-3)
    # what is lost by it: the voltage moves within a sample, which is of second order in its length
    for part in ("mass", "stiffness", "damping"):
        assert trace[f"x.estimate.{part}"][-1] == pytest.approx(1.0, abs=2e-3 * every**2)
    assert trace["x.error_pct"][-1] < 0.3 * every**2


def test_charge_sums_the_middle_of_every_sample():
    """Of a sine that is held or not, by the sum of sines at the start or the middle of each tick."""
    for drive, seen in (("held", 0.0), ("analogue", 0.5)):
        board = make({"plant.drive": drive})
        play(board, 300)
        angle = 1.0 * 0.01 * (np.arange(300) + seen)
        assert board.value("drive.charge") == pytest.approx(10.0 * np.sum(np.sin(angle)), rel=1e-9)
