"""The log, the digest and the names of signals."""

from __future__ import annotations

from typing import Any

import pytest

from core.board.log import KEPT, Log
from core.errors import InputError
from tests.lab import RICH, STORY, do, fault, make

FAST = {"reference.frequency_hz": 2000.0}


def test_log_is_numbered_and_only_grows():
    board = make({}, STORY, base=RICH)
    seen: list[Any] = []
    for _ in range(60):
        board.advance(5)
        entries = [entry.model_dump() for entry in board.log]
        assert entries[: len(seen)] == seen
        seen = entries
    assert [entry["seq"] for entry in seen] == list(range(1, len(seen) + 1))
    done = [entry for entry in seen if entry["actor"] == "test" and entry["kind"] != "scheduled"]
    assert [entry["tick"] for entry in done if entry["kind"] != "set"] == [20, 30, 41, 60, 90, 97, 110]
    for entry in seen:
        assert entry["text"] and "\n" not in entry["text"]


@pytest.mark.parametrize("kind", ["recognised", "alarm", "verdict", "region", "unexcited"])
def test_what_was_found_is_forgotten_in_time_what_was_done_never(kind):
    log = Log()
    deeds = []
    for tick in range(5 * KEPT):
        if tick % 100 == 0:
            deeds.append(log.add(tick, "test", "heal", "healed", {"heal": "all"}))
        log.add(tick, "board", kind, "found something")
    assert len(log) <= 2 * KEPT + len(deeds)
    assert [entry for entry in log if entry.command is not None] == deeds
    found = [entry.tick for entry in log if entry.command is None]
    assert found == list(range(5 * KEPT - len(found), 5 * KEPT)) and len(found) >= KEPT
    assert log.last == 5 * KEPT + len(deeds)


@pytest.mark.parametrize(
    ("command", "text"),
    [
        (fault("shock", 50.0), "inject shock +50\u00a0g"),
        (fault("sensor_bias", -0.2), "inject sensor_bias −200\u00a0nm"),
        (fault("added_mass", 0.05), "inject added_mass +0.05"),
        (fault("stiction", 3.0, profile={"kind": "ramp", "duration_ms": 1.0}), "inject stiction +3\u00a0nN, ramp"),
    ],
)
def test_the_log_says_how_strong_a_fault_is_and_in_what_unit(command, text):
    assert do(make({}), command).text == text


def test_the_order_of_the_log_does_not_depend_on_chunks():
    def told(chunk: int) -> list[tuple[int, str]]:
        board = make({}, [fault("added_mass", 0.05, at_sample=30)], base=RICH)
        while board.tick < 300:
            board.advance(chunk)
        return [(entry.tick, entry.text) for entry in board.log]

    assert told(1) == told(300)


def test_rows_are_the_ticks_asked_for():
    board = make(FAST)
    rows = board.advance(10)
    assert (rows.first_tick, rows.count, rows.outputs.shape[0], rows.taps.shape[0]) == (0, 10, 10, 10)
    rows = board.advance(100_000)
    assert rows.first_tick == 10 and rows.count == board.chunk == 512
    assert board.advance(0).count == 0 and board.tick == 522
    assert board.value("plant.displacement") == rows.outputs[-1, board.signals.index("plant.displacement")]


def test_signals_have_stable_names_units_and_order():
    signals = make({}, base=RICH).signals
    for name, unit in {
        "reference.voltage": "V",
        "model.displacement": "um",
        "plant.displacement": "um",
        "plant.velocity": "um/ms",
        "sensor.displacement": "um",
        "drive.voltage": "V",
        "open_loop.voltage": "V",
        "pid.voltage": "V",
        "mrac.voltage": "V",
        "mrac.augmented_error": "um",
        "faults.added_mass": "1",
        "faults.stiffness": "1",
        "faults.damping": "1",
        "kalman.probability.m+5": "1",
        "kalman.residual.healthy": "um",
        "kalman.winner": "1",
        "kalman.truth": "1",
        "mrac.gain.w1": "mixed",
        "mrac.gain_ideal.r": "mixed",
    }.items():
        assert signals[signals.index(name)].name == name
        assert signals[signals.index(name)].unit == unit
    assert [signal.index for signal in signals] == list(range(len(signals)))
    kinds = [signal.kind for signal in signals]
    assert kinds == sorted(kinds), "outputs before taps"
    with pytest.raises(InputError):
        signals.index("plant.displacment")
