"""Boards abreast give each board the bits it has alone."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from core import noise, registry
from core.board.abreast import Abreast
from core.board.board import Board
from core.board.commands import parse_command
from core.board.document import with_values
from core.board.facts import unlike
from core.board.lane_traces import LaneTraces
from core.board.parse import parse
from core.board.pattern import Pattern, Uneven
from core.compile import code
from core.compile.machine import WIDTH
from tests.lab import AXES_RICH, RICH

TICKS = 700
ONE_AFTER_ANOTHER = {"diagnose.moving_bank"}
"""Its models are numbered from a centre of its own in every board."""


def waiting(board: Board, events: list[dict[str, Any]]) -> Board:
    for event in events:
        board.apply(parse_command(event))
    return board


def alone(document: dict[str, Any], events: list[dict[str, Any]]) -> Board:
    board = waiting(Board(document), events)
    while board.tick < TICKS and board.advance(TICKS - board.tick).count:
        pass
    return board


def together(documents: list[dict[str, Any]], events: list[list[dict[str, Any]]], names: list[str]) -> Abreast:
    boards = [waiting(Board(parse(document)), own) for document, own in zip(documents, events, strict=True)]
    pattern = Pattern(boards[0])
    traces = LaneTraces(pattern.board.wiring, names, TICKS)
    return Abreast(pattern, [board.spec for board in boards], [board.pending for board in boards], traces)


EVENTS = [
    {"at_sample": 100, "fault": "added_mass", "severity": 0.1},
    {"at_sample": 250, "set": {"reference.amplitude_v": 6.0}},
    {"at_sample": 251, "fault": "sensor_dropout", "severity": 0.3},
    {"at_sample": 400, "heal": "all"},
]


def test_boards_with_seeds_of_their_own():
    documents = [with_values(RICH, {"seed": seed}) for seed in range(1, 7)]
    abreast = together(documents, [EVENTS] * 6, ["plant.displacement", "kalman.probability.m+5"])
    assert abreast.run(TICKS) == [True] * 6
    for lane, document in enumerate(documents):
        board = alone(document, EVENTS)
        assert abreast.boards[lane].digest() == board.digest()
        assert abreast.boards[lane].scores() == board.scores()
        assert abreast.trace(lane)["plant.displacement"][-1] == board.value("plant.displacement")


def test_boards_that_share_a_queue_keep_changes_of_values_to_themselves():
    """Commands that are not all for faults are carried out on each board: on the third one they change nothing."""
    documents = [with_values(RICH, {"reference.amplitude_v": volts, "seed": 3}) for volts in (4.0, 5.0, 6.0)]
    boards = [Board(parse(document)) for document in documents]
    waiting(boards[0], EVENTS)
    pattern = Pattern(boards[0])
    traces = LaneTraces(pattern.board.wiring, [], TICKS)
    abreast = Abreast(pattern, [board.spec for board in boards], [boards[0].pending] * 3, traces)
    assert abreast.run(TICKS) == [True] * 3
    assert [board.digest() for board in abreast.boards] == [alone(document, EVENTS).digest() for document in documents]


def test_the_trace_of_each_board_is_its_trace_alone():
    """Also between the slices that are sorted together, and of sums of signals."""
    documents = [with_values(RICH, {"seed": seed}) for seed in range(1, 4)]
    faults = ["kalman.probability.m+5", "kalman.winner", "plant.displacement"]
    boards = [waiting(Board(document), EVENTS) for document in documents]
    specs, queues = [board.spec for board in boards], [board.pending.copy() for board in boards]
    pattern, names = Pattern(boards[0]), ["drive.voltage", "sensor.displacement"]
    abreast = Abreast(pattern, specs, queues, LaneTraces(pattern.board.wiring, names, TICKS, {"sum": faults}))
    abreast.run(TICKS)
    for lane, document in enumerate(documents):
        board = waiting(Board(document), EVENTS)
        rows = np.vstack([board.advance(TICKS - board.tick).outputs.copy() for _ in range(2) if board.tick < TICKS])
        own = {name: rows[:, board.signals.index(name)] for name in board.signals.names if name in faults}
        trace = abreast.trace(lane)
        assert trace["sum"].tobytes() == (own[faults[0]] + own[faults[1]] + own[faults[2]]).tobytes()
        for name in ("drive.voltage", "sensor.displacement"):
            assert trace[name].tobytes() == rows[:, board.signals.index(name)].tobytes()


def test_boards_with_other_devices_commands_and_moments():
    documents = [
        with_values(RICH, {"device.bias_v": 5.0 + lane, "plant.drive_noise_v": 0.01 * lane, "seed": 4})
        for lane in range(5)
    ]
    events = [[{**EVENTS[0], "at_sample": 100 + 37 * lane, "severity": 0.02 * (lane + 1)}] for lane in range(5)]
    # a fault that acts at one board is part of the loop of all: none of them may begin while another has none
    with pytest.raises(Uneven, match="other blocks run"):
        together(documents, events, []).run(TICKS)
    events = [[{**EVENTS[0], "severity": 0.02 * (lane + 1)}] for lane in range(5)]
    abreast = together(documents, events, [])
    assert abreast.run(TICKS) == [True] * 5
    for lane, (document, own) in enumerate(zip(documents, events, strict=True)):
        assert abreast.boards[lane].digest() == alone(document, own).digest()


def test_boards_of_other_devices_follow_one_of_them_and_get_faults_of_their_own():
    """The effects of a broken truss follow from the drawing, and the lost samples of a dropout from the seed."""
    documents = [
        with_values(RICH, {"device": {"id": "lcr-350", "geometry": {"beam_width_um": width}}, "seed": seed})
        for width, seed in ((2.0, 1), (2.0, 2), (2.1, 2), (2.1, 2), (2.2, 5))
    ]
    faults = [
        {"at_sample": 100, "fault": "broken_truss", "severity": 0.5},
        {"at_sample": 150, "fault": "sensor_dropout", "severity": 0.3},
        {"at_sample": 400, "heal": ["broken_truss"]},
    ]
    abreast = together(documents, [faults] * 5, [])
    assert abreast.run(TICKS) == [True] * 5
    assert [len(board.followers) for board in abreast.boards] == [4, 0, 0, 0, 0]
    for lane, document in enumerate(documents):
        board = alone(document, faults)
        assert abreast.boards[lane].digest() == board.digest()
        assert abreast.boards[lane].faults == board.faults
        assert abreast.boards[lane].value("faults.broken_truss") == 0.0  # it rests again
    assert len({board.digest() for board in abreast.boards}) == 4


def test_what_a_block_reads_is_alike_to_the_sign_of_a_zero():
    spec = parse(RICH)
    context = spec.context()
    assert unlike(context, spec.with_seed(9).context()) == {"seed"}
    assert unlike(replace(context, limit_un=0.0), replace(context, limit_un=-0.0)) == {"limit_un"}
    pattern = Pattern(Board(spec))
    wiring = pattern.board.wiring
    plant, ideal, effects = (pattern.read[wiring.row(key)] for key in ("plant", "ideal", "effects"))
    assert "device" in plant and "seed" not in plant and ideal == effects == set()
    assert {"plant.drive", "sensor"} <= {stream for _, stream in pattern.streams}
    assert all(wiring.p[place] == noise.key(spec.seed, stream) for place, stream in pattern.streams)


def test_a_block_that_reads_other_facts_than_on_the_first_board():
    """Thermal noise follows from the temperature, which no other block of the loop reads."""
    values = [(False, 300.0), (False, 350.0), (True, 350.0), (True, 300.0), (True, 250.0)]
    documents = [with_values(RICH, {"plant.thermal_noise": n, "environment.temperature_k": t}) for n, t in values]
    abreast = together(documents, [EVENTS[:1]] * 5, [])
    assert abreast.run(TICKS) == [True] * 5
    digests = [alone(document, EVENTS[:1]).digest() for document in documents]
    assert [board.digest() for board in abreast.boards] == digests and len({*digests}) == 5


def test_two_axes_and_their_controllers():
    documents = [with_values(AXES_RICH, {"seed": seed}) for seed in (3, 4, 9)]
    abreast = together(documents, [[]] * 3, [])
    assert abreast.run(TICKS) == [True] * 3
    for lane, document in enumerate(documents):
        assert abreast.boards[lane].digest() == alone(document, []).digest()


def test_a_board_that_trips_leaves_and_the_others_go_on():
    documents = [with_values(RICH, {"guard.travel_um": travel, "seed": 2}) for travel in (25.0, 0.3, 20.0)]
    abreast = together(documents, [[]] * 3, [])
    boards = [alone(document, []) for document in documents]
    assert boards[1].trip is not None
    assert abreast.run(TICKS) == [True, False, True]
    assert [abreast.boards[lane].digest() == boards[lane].digest() for lane in (0, 2)] == [True, True]


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ({"sensor.kind": "capacitive"}, "structure"),
        ({"sample_rate_khz": 50}, "structure"),
        ({"diagnosers.kalman.form": "steady"}, "choices"),
        ({"diagnosers.kalman.hypotheses": [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}]}, "lengths"),
    ],
)
def test_boards_of_other_structures_are_refused(values, why):
    with pytest.raises(Uneven, match=why):
        together([RICH, with_values(RICH, values), RICH], [[]] * 3, [])


def test_a_board_that_waits_for_a_condition_runs_alone():
    board = waiting(Board(RICH), [{"when": "plant.displacement > 0.1", "fault": "added_mass", "severity": 0.1}])
    with pytest.raises(Uneven, match="condition"):
        Pattern(board)


def test_boards_that_get_another_block_run_alone():
    """An amplifier comes at a tick; each board then has one row more."""
    events = [[{"at_sample": 30, "set": {"board.amplifier_khz": 20.0}}]] * 3
    with pytest.raises(Uneven, match="came or went"):
        together([RICH] * 3, events, []).run(TICKS)


def test_controllers_that_look_on_are_left_out_unless_a_command_may_switch_to_them():
    pattern = Pattern(Board(RICH))
    wiring = pattern.board.wiring
    assert wiring.row("pid") in wiring.left_out and wiring.row("open_loop") not in wiring.left_out
    board = waiting(Board(RICH), [{"at_sample": 50, "switch": "pid"}])
    pattern = Pattern(board)
    assert board.wiring.row("pid") not in board.wiring.left_out and board.wiring.row("mrac") in board.wiring.left_out


@pytest.mark.long
@pytest.mark.timeout(300)
def test_all_steps_but_one_run_for_all_boards_at_once():
    blocks = {block for family in registry.FAMILIES for block in registry.blocks(family).values()}
    slow = {f"{block.family}.{block.name}" for block in blocks if not code.translated(block, WIDTH)[1]}
    assert slow == ONE_AFTER_ANOTHER
