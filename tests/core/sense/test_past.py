"""A unit that takes over in full motion: it begins with the place and the speed of the measurements before."""

from __future__ import annotations

import numpy as np
import pytest

from core.board.board import Board
from core.sense.past import KEPT
from tests import lab
from tests.core.sense.bench import DOCUMENT, make
from tests.lab import do, inner_digest, play

FRINGE_UM = 2.0
"""From one extreme of the light to the next: half of it off, and the light cannot tell a place from its reflection."""
FIRST = 300
PHASES = 8
SOURCES = {
    "ideal": {"sensor.kind": "ideal", "sensors.ideal.noise_um": 0.05},
    "capacitive": {"sensor.kind": "capacitive"},
    "quadrature": {"sensor.kind": "quadrature"},
    "quadrature_kalman": {"sensor.kind": "quadrature_kalman"},
}
TAKE_OVER = {"set": {"sensor.kind": "single_beam"}}


def moments(rate_khz: float) -> list[int]:
    """Return ticks all over a period of the drive, once the transient is small."""
    period = rate_khz / 2.0
    return [int(12 * period + i * period / PHASES) for i in range(PHASES)]


def taken_over(values: dict[str, object], ticks: int, *, fault: dict[str, float], seed: int) -> Board:
    board = make(values, seed=seed, stiffness=fault.get("stiffness", 0.0))
    play(board, ticks - 200)
    for name, severity in fault.items():
        if name != "stiffness":
            do(board, {"fault": name, "severity": severity})
    play(board, 200)
    do(board, TAKE_OVER)
    return board


def errors(values: dict[str, object], seeds: int = 1, ticks: int = 2000, **fault: float) -> np.ndarray:
    """Return the error from the first sample on, um, one row a moment and seed."""
    rate = float(values.get("sample_rate_khz", DOCUMENT["sample_rate_khz"]))
    drawn = [(at, 1 + (i + k) % 4) for i, at in enumerate(moments(rate)) for k in range(seeds)]
    boards = [taken_over(values, at, fault=fault, seed=seed) for at, seed in drawn]
    return np.array([play(board, ticks)["single_beam.error"] for board in boards])


def running(values: dict[str, object], stiffness: float) -> float:
    """Return the worst error over the same samples of a unit that ran all the time."""
    worst = []
    for seed in range(1, 5):
        board = make({**values, "sensors.single_beam.always": True}, seed=seed, stiffness=stiffness)
        first = moments(board.spec.frame.sample_rate_khz)
        error = play(board, first[-1] + FIRST)["single_beam.error"]
        worst.append(np.abs(error[first[0] :]).max())
    return max(worst)


CASES = [(source, rate, stiffness) for source in SOURCES for stiffness in (0.0, -0.1, 0.3) for rate in (100.0, 518.0)]
PAIRS = [case for at, case in enumerate(CASES) if (at // 2 + at) % 2]
"""Each source with each stiffness and each rate, and each stiffness with each rate."""


@pytest.mark.parametrize(("source", "rate", "stiffness"), PAIRS)
def test_takes_over_at_any_phase_as_if_it_had_always_run(source, rate, stiffness):
    as_if_it_had_always_run(source, rate, stiffness, seeds=1)


@pytest.mark.long
@pytest.mark.parametrize(("source", "rate", "stiffness"), CASES)
def test_takes_over_at_any_phase_with_four_seeds_at_each(source, rate, stiffness):
    as_if_it_had_always_run(source, rate, stiffness, seeds=4)


def as_if_it_had_always_run(source: str, rate: float, stiffness: float, seeds: int) -> None:
    values = {**SOURCES[source], "sample_rate_khz": rate}
    error = np.abs(errors(values, seeds, stiffness=stiffness))
    assert error[:, :FIRST].max() < FRINGE_UM / 4
    assert error[:, FIRST // 3 : FIRST].max() < 1.1 * running(values, stiffness)
    assert not (error > FRINGE_UM).any()


@pytest.mark.parametrize(
    ("values", "fault"),
    [
        ({"sensor.every": 8}, {}),
        ({"sensors.single_beam.every": 4}, {}),
        ({}, {"sensor_dropout": 0.5}),
        ({}, {"sensor_quantisation": 0.5}),
    ],
)
def test_takes_over_from_samples_that_are_rare_lost_or_coarse(values, fault):
    error = np.abs(errors({"sensor.kind": "ideal", **values}, **fault))
    assert error[:, :FIRST].max() < FRINGE_UM / 4
    assert not (error > FRINGE_UM).any()


def test_speed_is_better_than_that_of_a_parabola_through_the_past():
    off = []
    for seed in range(1, 4):
        for at in moments(518.0):
            board = taken_over(SOURCES["ideal"], at, fault={}, seed=seed)
            play(board, 1)
            off.append(board.wiring.state("single_beam").hypotheses[0].v - board.value("plant.velocity"))
    # the end slope of a least squares parabola through n samples has the variance 192/n^3 (sigma/dt)^2
    parabola = 0.05 * 518.0 * np.sqrt(192.0 / KEPT**3)
    assert np.sqrt(np.mean(np.square(off))) < parabola


def test_begins_at_rest_where_nothing_was_measured_before():
    board = make({"sensor.kind": "single_beam"})
    play(board, 1)
    always = make({"sensor.kind": "ideal", "sensors.single_beam.always": True})
    play(always, 1)
    np.testing.assert_array_equal(board.wiring.state_of("single_beam"), always.wiring.state_of("single_beam"))
    assert abs(board.wiring.state("single_beam").hypotheses[0].v) < 1.0


@pytest.mark.parametrize("before", [1, KEPT // 2, 3 * KEPT])
def test_a_copy_takes_over_like_the_board_itself(before):
    straight = make(SOURCES["ideal"])
    do(straight, {**TAKE_OVER, "at_sample": 1500})
    play(straight, 1500 - before)
    forks = [Board.restore(straight.checkpoint()) for _ in range(2)]
    play(straight, 2000)
    for fork in forks:
        while fork.tick < straight.tick:
            fork.advance(min(7, straight.tick - fork.tick))
        assert fork.digest() == straight.digest()
        assert inner_digest(fork) == inner_digest(straight)


def test_plain_code_takes_over_like_compiled_code():
    found = []
    for compiled in (True, False):
        board = lab.make(SOURCES["ideal"], base=DOCUMENT, compiled=compiled)
        do(board, {**TAKE_OVER, "at_sample": 100})
        play(board, 200)
        found.append((board.digest(), inner_digest(board)))
    assert found[0] == found[1]
