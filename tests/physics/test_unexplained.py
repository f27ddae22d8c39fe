"""The self-knowledge of a bank: that no hypothesis fits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats
from scipy.signal import lfilter

from core.block import Context
from core.diagnose.hypothesis import Hypothesis
from core.loop import score
from core.plain import plain
from tests.lab import do, fault, make, play
from tests.physics.bank import BENCH, NOMINAL, of_bank, signals

LIMIT = stats.chi2.isf(1e-6, 49) / 49
SETTLED = 500
EXACT = {"diagnosers.kalman.process_noise_v": 0.01}


def averages(nis: np.ndarray) -> np.ndarray:
    """Average with weights (1 - 1/25)^k, from 1 on, of what counts 100 at most."""
    kept = 1.0 - 1.0 / 25.0
    square = np.minimum(np.where(np.isnan(nis), 100.0, nis), 100.0)
    return lfilter([1.0 - kept], [1.0, -kept], square, axis=0, zi=np.full((1, nis.shape[1]), kept))[0]


@pytest.mark.parametrize("faults", [{}, {"added_mass": 0.05}, {"added_mass": 9.0}])
def test_the_least_average_against_its_definition(faults):
    trace = signals(800, faults=faults)
    least = averages(of_bank(trace, "nis")).min(axis=1)
    np.testing.assert_allclose(trace["kalman.least_nis"], least, rtol=1e-9)
    assert np.array_equal(trace["kalman.unexplained"], (least > LIMIT).astype(float))


@pytest.mark.parametrize(("name", "severity"), [("added_mass", 0.05), ("stiffness", 0.1), ("damping", 0.3)])
@pytest.mark.parametrize("seed", [1, 2])
def test_what_a_hypothesis_says_is_explained(name, severity, seed):
    trace = signals(20_000, {"seed": seed}, {name: severity})
    assert not trace["kalman.unexplained"][SETTLED:].any()


@pytest.mark.parametrize(("name", "severity"), [("added_mass", 9.0), ("drive_gain", -0.5), ("sensor_noise", 0.5)])
def test_what_no_hypothesis_says_is_not_and_a_healed_device_is_again(name, severity):
    board = make(BENCH)
    assert not play(board, 1000)["kalman.unexplained"].any()
    do(board, fault(name, severity))
    seen = play(board, 2000)
    assert seen["kalman.unexplained"][100:].all()
    assert seen["kalman.probability.healthy"][-1] < 0.5 or name == "sensor_noise"  # it names something all the same
    assert board.scores()["kalman"].unexplained
    do(board, {"heal": "all"})
    assert not play(board, 2000)["kalman.unexplained"][SETTLED:].any()
    score_now = board.scores()["kalman"]
    assert not score_now.unexplained and score_now.least_nis < LIMIT


def test_residuals_that_are_no_numbers_are_unexplained_and_forgotten():
    params = score.Score.Params(hypotheses=[Hypothesis(name="healthy"), Hypothesis(name="m+5", mass=1.05)])
    context = Context(dt_ms=0.01, every=1, seed=0, device=NOMINAL, model=NOMINAL)
    p, s = score.Score.pack(params, context), score.Score.state(params, context)
    step = plain(score.Score.step)
    w = np.ones(32)
    # probability, nis, four scales, other, the environment twice; winner, truth; taps, the last of them unexplained
    x = score.Score.Ports(w, np.array([2, 4, 6, 6, 6, 6, 7, 6, 6, 8, 9, 10, 11, 12, 13, 14]))
    w[2:4], w[7] = 0.5, 0.0
    for nis, expected in ((math.nan, 1.0), (math.inf, 1.0), (1.0, 0.0)):
        w[4:6] = nis
        for _ in range(200):
            step(p, s, x)
        assert w[14] == expected


@pytest.mark.long
def test_a_true_hypothesis_is_called_unexplained_no_more_often_than_by_chance():
    """White residuals: an average whose weights fall off has a longer tail than the chi-square that sets the limit."""
    random = np.random.default_rng(1)
    over = sum(np.count_nonzero(averages(random.standard_normal((1_000_000, 1)) ** 2)[200:] > LIMIT) for _ in range(4))
    assert over / 4e6 < 2e-5
