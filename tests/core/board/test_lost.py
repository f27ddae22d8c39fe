"""A block whose state is finite no longer trips the board, whatever its family and whatever the slices."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import repeat
from typing import Any

import numpy as np
import pytest

from core.board.board import Board
from core.board.hosted import Hosted
from core.board.lost import EVERY, lost
from core.board.parse import parse
from core.board.stored import revived, stored
from core.estimation import HIGHEST
from tests.core.board.test_abreast import TICKS, together
from tests.lab import AXES_RICH, QUIET, RICH, do, document, make, play

DIVERGES = {"identifiers": {"id": {"kind": "gradient", "normalise": False, "adaptation_gain": 1e3, "range_ratio": 0.0}}}
"""An identifier that runs away, and infinite at a tick that is no multiple of anything."""
TONES = [{"frequency_hz": 1000.0}, {"frequency_hz": 3100.0}]
FIRST = 84
REASON = f"the state of id has not been finite since sample {FIRST}"


def board() -> Board:
    """Return a bench whose identifier is lost at a tick of its own, with something to do in between."""
    commands = [{"set": {"guard.travel_um": 20.0}, "at_sample": at} for at in (50, 300)]
    return make(DIVERGES, commands, base=RICH)


def in_slices(one: Board, ticks: int) -> Board:
    """Advance a board by so many ticks at a time until it trips."""
    while one.advance(ticks).count:
        pass
    return one


def test_the_first_tick_is_that_of_the_state() -> None:
    one = board()
    for tick in range(1, FIRST + 1):
        one.advance(1)
        assert bool(lost(one.wiring, one.spec)) is (tick == FIRST)


@pytest.mark.parametrize("ticks", [1, 7, FIRST - 1, FIRST, FIRST + 1, 100, 500, EVERY - 1, EVERY])
def test_no_slice_changes_when_and_why_it_trips(ticks: int) -> None:
    whole, cut = in_slices(board(), EVERY), in_slices(board(), ticks)
    assert whole.trip is not None and (whole.trip.tick, whole.trip.reason) == (EVERY, REASON)
    assert cut.trip == whole.trip and cut.digest() == whole.digest()
    assert [(entry.tick, entry.text) for entry in cut.log] == [(entry.tick, entry.text) for entry in whole.log]
    assert cut.value("drive.voltage") == 0.0


def test_plain_python_trips_at_the_same_tick_for_the_same_reason() -> None:
    one, other = (in_slices(make(DIVERGES, compiled=compiled), 300) for compiled in (True, False))
    assert one.trip == other.trip is not None and one.digest() == other.digest()


@pytest.mark.parametrize("ticks", [FIRST - 1, FIRST, 200])
@pytest.mark.parametrize("again", [lambda one: Board.restore(one.checkpoint()), lambda one: revived(stored(one))])
def test_a_copy_trips_as_the_board_does(again: Callable[[Board], Board], ticks: int) -> None:
    one = board()
    play(one, ticks)
    copy = again(one)
    assert in_slices(copy, 100).trip == in_slices(one, EVERY).trip is not None
    assert copy.digest() == one.digest()


def test_a_board_with_a_part_from_outside_trips_at_the_same_tick() -> None:
    """An outside part may give no answer for any time: its state begins as NaN."""
    answers = {"odd": lambda _: repeat(math.nan, 3)}
    one = Hosted(parse(document({}, RICH)), identifiers=answers)
    play(one, 2 * EVERY)
    assert one.trip is None and math.isnan(one.value("odd.estimate.mass"))
    one = Hosted(parse(document(DIVERGES, RICH)), identifiers=answers)
    assert in_slices(one, 100).trip == in_slices(make(DIVERGES, base=RICH), 100).trip is not None


def test_a_board_among_others_leaves_and_the_others_keep_their_bits() -> None:
    documents = [document({**DIVERGES, "identifiers.id.adaptation_gain": gain}, RICH) for gain in (1e-3, 1e3, 2e-3)]
    abreast = together(documents, [[]] * 3, [])
    assert abreast.run(TICKS) == [True, False, True]
    for lane in (0, 2):
        alone = Board(documents[lane])
        play(alone, TICKS)
        assert abreast.boards[lane].digest() == alone.digest()


def test_after_a_reset_it_starts_anew() -> None:
    one = in_slices(board(), 100)
    do(one, {"set": {"identifiers.id.adaptation_gain": 1e-3}})
    do(one, {"reset_trip": True})
    play(one, 2 * EVERY)
    assert one.trip is None and math.isfinite(one.value("id.estimate.mass"))


@pytest.mark.parametrize("poison", [math.nan, math.inf])
@pytest.mark.parametrize("base", [RICH, AXES_RICH])
def test_no_block_of_any_family_stays_lost_in_silence(base: dict[str, Any], poison: float) -> None:
    values: dict[str, Any] = {"identifiers": {"rls": {"kind": "recursive_least_squares"}}} if base is RICH else {}
    keys = [one.key for one in make(values, base=base).wiring.instances]
    told = set()
    for key in keys:
        one = make(values, base=base)
        play(one, 100)
        one.wiring.state_of(key)[:] = poison
        play(one, EVERY)
        aside = key in one.spec.controllers and key not in one.spec.driving.values()
        if one.trip is None:
            assert aside or np.isfinite(one.wiring.s).all(), key
        else:
            assert not aside and one.tick <= EVERY, key
            told |= {key} if one.trip.reason.startswith("the state of ") else set()
    if base is RICH:
        assert {"rls", "rls.score", "kalman", "reference", "model", "environment"} & told >= {"rls", "kalman"}
    else:
        assert {"kalman", "allan"} <= told


@pytest.mark.parametrize(
    ("kind", "own"), [("recursive_least_squares", {}), ("least_squares", {"forgetting_rate": 1e4, "normaliser": 0.0})]
)
def test_an_identifier_without_a_limit_survives_no_excitation(kind: str, own: dict[str, float]) -> None:
    """The mass rises by a fifth after .34 s without a voltage, in which a forgetting covariance grows by 1e300."""
    values = {
        "reference": {"kind": "multi_sine", "amplitude_v": 10.0, "tones": TONES},
        "identifiers": {"id": {"kind": kind, "covariance_limit": 0.0, **own}},
    }
    one = make(values, base=QUIET)
    play(one, 2000)
    do(one, {"set": {"reference.amplitude_v": 0.0}})
    play(one, 34_000)
    assert one.trip is None and one.value("id.covariance_trace") <= HIGHEST
    do(one, {"fault": "added_mass", "severity": 0.2})
    do(one, {"set": {"reference.amplitude_v": 10.0}})
    play(one, 6000)
    assert one.trip is None and one.value("id.truth.mass") == pytest.approx(1.2)
    assert one.value("id.estimate.mass") == pytest.approx(1.2, rel=0.01)
