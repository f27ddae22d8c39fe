"""Boards that a program drives have the bits of a board with the same law, abreast or alone, whatever comes between."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.board.board import Board
from core.board.driven import DRIVEN, DrivenBoards
from core.board.parse import changed
from core.board.pattern import Pattern, Uneven
from core.errors import InputError
from scenarios.campaign.batch import waiting
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build_hosted
from scenarios.schema import Scenario

COLUMNS = ("reference.voltage", "model.displacement", "sensor.displacement", "plant.displacement")
FEW = {"samples": 700, "diagnosers": {}}
MASS = {"fault": "added_mass", "severity": 0.05, "at_sample": 100}
DEBRIS = {"fault": "debris", "severity": 0.5, "at_sample": 203}
SET = {"set": {"sensor.noise_um": 0.2}, "at_sample": 333}


def scenario_of(**values: Any) -> Scenario:
    return with_values(get("first-look"), {**FEW, **values})


def driven(scenario: Scenario, count: int, frame: int) -> tuple[DrivenBoards, Any]:
    board = Board(changed(scenario.spec, DRIVEN))
    board.pending = waiting(scenario, board)
    events = board.pending.copy()
    return DrivenBoards(Pattern(board), count, frame, COLUMNS), events


def voltage(tick: int, place: int) -> float:
    return float(8.0 * np.sin(0.1 * tick + place))


def play(boards: DrivenBoards, events: Any, scenario: Scenario, frames: int, frame: int) -> None:
    spec = changed(scenario.spec, DRIVEN)
    for place in range(len(boards.boards)):
        boards.begin(place, spec.with_seed(place + 1), events.copy())
    for number in range(frames):
        places = np.flatnonzero(~boards.gone)
        boards.advance(places, np.array([voltage(number * frame, place) for place in places]))


def alone(scenario: Scenario, place: int, samples: int, frame: int) -> Any:
    """Return the board of another loop that holds the same voltages."""
    board = build_hosted(scenario, place + 1, law=lambda x: voltage(x.tick - x.tick % frame, place))
    while board.tick < samples and board.advance(min(512, samples - board.tick)).count:
        pass
    return board


@pytest.mark.parametrize(("count", "frame"), [(1, 1), (2, 7), (5, 1), (11, 7)])
def test_each_has_the_digest_of_a_board_with_a_law(count: int, frame: int) -> None:
    scenario = scenario_of(events=[MASS, DEBRIS, SET])
    boards, events = driven(scenario, count, frame)
    play(boards, events, scenario, 630 // frame, frame)
    for place in {0, count - 1}:
        other = alone(scenario, place, 630, frame)
        assert boards.boards[place].tick == other.tick == 630
        assert boards.boards[place].digest() == other.digest()
    assert len({board.digest() for board in boards.boards}) == count


def test_boards_with_other_faults_and_other_ticks_keep_their_bits() -> None:
    """One has a fault of its own with a state, one begins anew in between, one trips; the others go on abreast."""
    scenario, frame = scenario_of(**{"guard.travel_um": 2.4, "events": []}), 5
    faulty = scenario_of(**{"guard.travel_um": 2.4, "events": [DEBRIS]})
    boards, events = driven(scenario, 6, frame)
    spec, own = changed(scenario.spec, DRIVEN), driven(faulty, 1, frame)[1]
    for place in range(6):
        boards.begin(place, spec.with_seed(place + 1), own.copy() if place == 4 else events.copy())
    began = [0] * 6
    for number in range(120):
        if number == 31:
            boards.begin(2, spec.with_seed(3), events.copy())
            began[2] = number * frame
        places = np.flatnonzero(~boards.gone)
        volts = [voltage(number * frame - began[place], place) * (3.0 if place == 1 else 1.0) for place in places]
        boards.advance(places, np.array(volts))
    assert [place for place, board in enumerate(boards.boards) if board.trip is not None] == [1]
    assert boards.counts[1] < frame or boards.boards[1].tick % frame == 0
    for place in (0, 2, 4, 5):
        other = alone(faulty if place == 4 else scenario, place, 600 - began[place], frame)
        assert boards.boards[place].digest() == other.digest(), place
    tripped = build_hosted(scenario, 2, law=lambda x: 3.0 * voltage(x.tick - x.tick % frame, 1))
    while tripped.advance(512).count:
        pass
    trip = boards.boards[1].trip
    assert trip is not None and tripped.trip is not None
    assert (trip.tick, trip.reason) == (tripped.trip.tick, tripped.trip.reason)
    assert boards.boards[1].digest() == tripped.digest()


def test_signals_are_kept_at_the_cut_of_each_tick() -> None:
    scenario = scenario_of(events=[MASS])
    boards, events = driven(scenario, 3, 4)
    play(boards, events, scenario, 30, 4)
    seen: list[Any] = []

    def law(sample: Any) -> float:
        seen.append((sample.reference, sample.model, sample.measured))
        return voltage(sample.tick - sample.tick % 4, 1)

    board = build_hosted(scenario, 2, law=law)
    board.advance(121)
    np.testing.assert_array_equal(boards.kept(np.array([1]))[:, :3, 0], seen[117:121])


def test_another_structure_is_refused() -> None:
    scenario = scenario_of()
    boards, events = driven(scenario, 1, 1)
    other = changed(scenario.spec, {**DRIVEN, "plant.model": "nonlinear"})
    with pytest.raises(Uneven):
        boards.begin(0, other, events.copy())


def test_an_event_that_exchanges_a_block_is_refused() -> None:
    scenario = scenario_of(events=[{"set": {"board.amplifier_khz": 20.0}, "at_sample": 3}])
    boards, events = driven(scenario, 1, 10)
    with pytest.raises(InputError, match="exchanges a block"):
        play(boards, events, scenario, 1, 10)
