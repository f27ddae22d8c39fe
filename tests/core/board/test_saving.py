"""The history of a board, saved and run again to the same bits."""

from __future__ import annotations

import itertools
from typing import Any

import pytest
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

from core.board.board import Board
from core.board.commands import parse_command
from core.errors import InputError
from scenarios.run import build, run
from scenarios.schema import Scenario
from tests.lab import RICH, STORY, do, fault, inject, make, play, run_digest

FAST = {"reference.frequency_hz": 2000.0}


COMMANDS = st.one_of(
    st.builds(
        lambda name, severity, kind: fault(
            name, severity, profile={"kind": kind, "duration_ms": 0.3, "period_ms": 0.1}
        ),
        st.sampled_from(["added_mass", "stiffness", "damping"]),
        st.floats(-0.5, 2.0),
        st.sampled_from(["step", "ramp", "intermittent"]),
    ),
    st.builds(
        lambda name, severity, ticks: fault(name, severity, at_ms=ticks * 0.01),
        st.sampled_from(["added_mass", "stiffness", "damping"]),
        st.floats(-0.5, 2.0),
        st.integers(0, 600),
    ),
    st.builds(
        lambda name, level, sign: fault(name, 0.4, when=f"plant.velocity {sign} {level}"),
        st.sampled_from(["added_mass", "stiffness", "damping"]),
        st.floats(-20, 20),
        st.sampled_from("<>"),
    ),
    st.just({"heal": "all"}),
    st.builds(
        lambda name, cold: {"switch": name, "cold": cold}, st.sampled_from(["open_loop", "pid", "mrac"]), st.booleans()
    ),
    st.builds(
        lambda values: {"set": values},
        st.sampled_from(
            [
                {"reference.amplitude_v": 20.0},
                {"reference.kind": "square"},
                {"controller.kind": "pid", "controllers.pid.pole": 1.0},
                {"controllers.mrac.adaptation_gain": 3000.0},
                {"controllers.mrac.adaptation_gain": 0.5},
                {"plant.model": "nonlinear"},
                {"diagnosers.kalman.probability_floor": 0.01, "diagnosers.kalman.form": "steady"},
                {"sensor.noise_um": 0.3, "guard.travel_um": 4.0},
            ]
        ),
    ),
    st.just({"reset_trip": True}),
)


def attempt(board: Board, command: dict[str, Any]) -> None:
    try:
        do(board, command)
    except InputError:
        pass


@settings(max_examples=40, phases=[Phase.generate])  # shrinking a story takes minutes
@given(story=st.lists(st.tuples(st.integers(0, 120), COMMANDS), min_size=1, max_size=12), more=st.integers(1, 200))
def test_a_saved_bench_runs_to_the_same_bits(story, more):
    board = make({}, base=RICH)
    play(board, 1)
    for gap, command in story:
        play(board, gap)
        attempt(board, command)
    assume(not any(waiting.condition for waiting in board.pending))
    saved = board.save()
    again = run(Scenario.load(saved))
    assert again.digest == board.digest() and again.board.tick == board.tick
    # what still waits, waits in the copy as well
    copy = build(Scenario.load(Scenario.load(saved).toml()))
    play(copy, board.tick)
    play(copy, more)
    play(board, more)
    assert copy.digest() == board.digest() and copy.tick == board.tick
    assert (copy.trip is None) == (board.trip is None)


def test_a_condition_that_still_waits_is_saved():
    board = make(FAST)
    highest = play(board, 200)["plant.displacement"].max()
    while board.value("plant.displacement") > 0:
        play(board, 1)
    # it held before it was given, and never will again
    do(board, fault("damping", 0.4, when=f"plant.displacement > {0.95 * highest}"))
    do(board, {"set": {"reference.amplitude_v": 0.1}})
    play(board, 400)
    assert board.pending and not board.faults
    assert run(Scenario.load(board.save())).digest == board.digest()


def test_a_saved_bench_with_a_trip_and_a_reset():
    board = make({"controller": {"kind": "mrac", "adaptation_gain": 30.0}})
    inject(board, stiffness=1.0)
    play(board, 2000)
    assert board.trip is not None
    do(board, {"set": {"controllers.mrac.adaptation_gain": 1.0}})
    do(board, {"reset_trip": True})
    play(board, 777)
    do(board, {"switch": "pid"})
    play(board, 300)
    assert run(Scenario.load(board.save())).digest == board.digest()


def test_a_bench_that_has_not_run_can_be_saved():
    board = make()
    inject(board, stiffness=0.2)
    copy = build(Scenario.load(board.save()))
    assert run_digest(copy, 50) == run_digest(board, 50)


def test_a_fork_can_be_saved():
    board = make({}, STORY[:4], base=RICH)
    play(board, 55)
    fork = Board.restore(board.checkpoint())
    inject(fork, damping=1.0)
    play(fork, 100)
    assert run(Scenario.load(fork.save())).digest == fork.digest()


def test_commands_are_checked_before_they_reach_a_board():
    for command in (None, [], "heal", {"kind": "heal"}, {"heal": None}, {"heal": {}}):
        with pytest.raises(InputError):
            parse_command(command)


def test_boards_do_not_share_anything():
    first, second = make({}, base=RICH), make({}, base=RICH)
    a, b = [], []
    for board, digests in itertools.islice(itertools.cycle([(first, a), (second, b)]), 10):
        digests.append(run_digest(board, 37))
    assert a == b
