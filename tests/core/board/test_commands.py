"""Commands at tick edges: when they take effect, and on which condition."""

from __future__ import annotations

import numpy as np
import pytest

from core.errors import InputError
from tests.lab import do, fault, make, play

FAST = {"reference.frequency_hz": 2000.0}


@pytest.mark.parametrize("moment", [{"at_sample": 50}, {"at_ms": 0.5}, {"at_ms": 0.5049}, {"at_ms": 0.4951}])
def test_a_fault_takes_effect_at_its_tick(moment):
    healthy = play(make(FAST), 100)
    trace = play(make(FAST, [fault("stiffness", 0.5, **moment)]), 100)
    assert np.array_equal(trace["faults.stiffness"], np.r_[np.zeros(50), np.full(50, 0.5)])
    assert np.array_equal(trace["effects.stiffness_scale"], np.r_[np.ones(50), np.full(50, 1.5)])
    same = trace["plant.displacement"] == healthy["plant.displacement"]
    assert np.all(same[:51]) and not np.any(same[51:])


def test_a_parameter_takes_effect_at_its_tick():
    command = {"set": {"reference.amplitude_v": 3.0, "sensor.noise_um": 0.5}, "at_sample": 70}
    trace, plain = play(make(FAST, [command]), 100), play(make(FAST), 100)
    np.testing.assert_allclose(trace["reference.voltage"][70:], 0.3 * plain["reference.voltage"][70:], rtol=1e-14)
    assert np.array_equal(trace["reference.voltage"][:70], plain["reference.voltage"][:70])
    noise = trace["sensor.displacement"] - trace["plant.displacement"]
    assert not noise[:70].any() and noise[70:].all()


def test_commands_of_one_tick_take_effect_in_the_order_given():
    commands = [
        fault("added_mass", 0.1, at_sample=10),
        {"heal": ["added_mass"], "at_sample": 20},
        fault("added_mass", 0.3, at_sample=20),
    ]
    trace = play(make(FAST, commands), 30)
    assert trace["faults.added_mass"][19:22].tolist() == [0.1, 0.3, 0.3]


def test_a_moment_that_has_passed_is_refused():
    board = make(FAST)
    play(board, 10)
    with pytest.raises(InputError, match="has passed"):
        do(board, fault("stiffness", 0.1, at_sample=9))
    do(board, fault("stiffness", 0.1, at_sample=10))
    assert play(board, 1)["faults.stiffness"][0] == 0.1


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        ("plant.displacement > 1.5", lambda x: x > 1.5),
        ("plant.displacement < -0.25", lambda x: x < -0.25),
        ("  plant.displacement>1e-3", lambda x: x > 1e-3),
    ],
)
def test_a_condition_takes_effect_at_the_edge_after_it_holds(condition, holds):
    plain = play(make(FAST), 400)
    first = int(np.argmax(holds(plain["plant.displacement"])))
    assert first > 0
    board = make(FAST, [fault("damping", 0.5, when=condition)])
    trace = play(board, 400)
    assert np.flatnonzero(trace["faults.damping"])[0] == first + 1
    assert np.all(trace["faults.damping"][first + 1 :] == 0.5), "once"
    entry = next(entry for entry in board.log if entry.kind == "inject")
    assert entry.tick == first + 1


@pytest.mark.parametrize("chunk", [1, 7, 512])
def test_conditions_do_not_depend_on_chunks(chunk):
    def digest(n: int) -> str:
        board = make(FAST, [fault("damping", 0.5, when="plant.velocity > 20"), fault("added_mass", 0.1, at_sample=33)])
        while board.tick < 300:
            board.advance(min(n, 300 - board.tick))
        return board.digest()

    assert digest(chunk) == digest(300)


def test_two_conditions_met_at_once_both_take_effect():
    commands = [
        fault("damping", 0.5, when="plant.displacement > 1"),
        fault("stiffness", 0.5, when="plant.displacement > 1"),
    ]
    trace = play(make(FAST, commands), 300)
    first = [int(np.flatnonzero(trace[f"faults.{name}"])[0]) for name in ("damping", "stiffness")]
    assert first[0] == first[1]


@pytest.mark.parametrize(
    "condition",
    [
        "",
        "plant.displacement",
        "nothing > 1",
        "plant.displacement > x",
        "plant.displacement > nan",
        "plant.displacement >= 1",
    ],
)
def test_bad_conditions_are_refused(condition):
    board = make(FAST)
    with pytest.raises(InputError) as error:
        do(board, fault("damping", 0.5, when=condition))
    assert error.value.field == "when"
    assert not board.pending and not board.log
