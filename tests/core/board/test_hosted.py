"""A controller computed outside drives with the same delay, and the same bits, as one of the library."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core import registry
from core.board.board import Board
from core.board.hosted import Hosted
from core.board.outside import Law, Sample
from core.board.parse import parse
from core.errors import InputError
from tests.lab import RICH, do, document, make, play

SIGNALS = ("plant.displacement", "plant.velocity", "sensor.displacement", "drive.voltage", "kalman.probability.m+5")
GAINS = {"proportional_v_um": 2.0, "integral_v_um_ms": 9.0, "derivative_v_ms_um": 0.0}


class Pi:
    """The law of `core.control.pid` without its derivative, written in Python as its equation says."""

    def __init__(self, sign: float, limit_v: float = 30.0) -> None:
        self.kp, self.ki, self.limit = sign * GAINS["proportional_v_um"], sign * GAINS["integral_v_um_ms"], limit_v
        self.integral = 0.0

    def __call__(self, x: Sample) -> float:
        if x.begins:
            self.integral = 0.0
        e = x.model - x.measured
        proportional = self.kp * e
        if not x.engaged:
            self.integral = x.applied - proportional
            return proportional + self.integral
        increment = self.ki * e * x.dt_ms
        u = proportional + self.integral + increment
        if abs(u) <= self.limit or u * increment < 0.0:
            self.integral += increment
        return proportional + self.integral


def hosted(law: Law, values: dict[str, Any] | None = None, *, compiled: bool = True) -> Hosted:
    return Hosted(parse(document(values or {}, RICH)), law, compiled=compiled)


def pi() -> Pi:
    return Pi(math.copysign(1.0, parse(document({}, RICH)).nominal.force))


def library() -> Board:
    return make({"controller": {"kind": "pid", **GAINS}}, base=RICH)


def assert_same_bits(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> None:
    for name in SIGNALS:
        assert one[name].tobytes() == other[name].tobytes(), name


def test_a_law_in_python_gives_the_bits_of_the_same_law_compiled() -> None:
    own, compiled = play(hosted(pi()), 1200), play(library(), 1200)
    assert_same_bits(own, compiled)
    assert own["external.voltage"].tobytes() == compiled["pid.voltage"].tobytes()
    assert np.ptp(own["drive.voltage"]) > 1.0


def test_it_has_no_delay_of_its_own_and_one_more_sample_would_be_seen() -> None:
    """The open loop, u = r, written as a law; held back by a sample it is another trace."""
    late = [0.0]

    def delayed(x: Sample) -> float:
        late.append(x.reference)
        return late[-2]

    loop = play(make(base=RICH), 300)
    assert_same_bits(play(hosted(lambda x: x.reference), 300), loop)
    assert play(hosted(delayed), 300)["drive.voltage"].tobytes() != loop["drive.voltage"].tobytes()


def test_the_uncompiled_board_gives_the_same_bits() -> None:
    fast, slow = hosted(pi()), hosted(pi(), compiled=False)
    play(fast, 60)
    play(slow, 60)
    assert fast.digest() == slow.digest()


def test_it_reads_what_the_trace_says_and_nothing_of_the_truth() -> None:
    seen: list[Sample] = []

    def law(x: Sample) -> float:
        seen.append(x)
        return -x.measured

    trace = play(hosted(law), 200)
    for field, signal in (("reference", "reference.voltage"), ("model", "model.displacement")):
        assert [getattr(x, field) for x in seen] == trace[signal].tolist()
    assert [x.measured for x in seen] == trace["sensor.displacement"].tolist()
    assert [x.applied for x in seen[1:]] == trace["drive.voltage"][:-1].tolist() and seen[0].applied == 0.0
    assert [x.tick for x in seen] == list(range(200)) and [x.begins for x in seen] == [True, *[False] * 199]
    assert seen[7].time_ms == pytest.approx(7 * 0.01) and seen[7].dt_ms == 0.01
    assert {*Sample._fields}.isdisjoint({"displacement", "velocity", "mass_scale"})


STORY = [
    {"fault": "added_mass", "severity": 0.05, "at_sample": 100},
    {"switch": "open_loop", "at_sample": 150},
    {"set": {"reference.amplitude_v": 5.0, "controllers.mrac.adaptation_gain": 0.5}, "at_sample": 170},
]


def test_events_meet_it_as_they_meet_any_controller() -> None:
    """It is switched away and back; in shadow it follows the voltage that is applied, as the PID does."""
    traces = []
    for name, board in (("external", hosted(pi())), ("pid", library())):
        for command in (*STORY, {"switch": name, "at_sample": 300}):
            do(board, command)
        traces.append(play(board, 500))
    assert_same_bits(*traces)


def test_it_begins_anew_after_a_reset_and_at_a_cold_start() -> None:
    begun: list[int] = []

    def law(x: Sample) -> float:
        if x.begins:
            begun.append(x.tick)
        return math.nan if x.tick == 50 else 0.0

    board = hosted(law)
    assert len(play(board, 100)["drive.voltage"]) == 51
    assert board.trip is not None and board.trip.signal == "external.voltage"
    do(board, {"reset_trip": True})
    play(board, 20)
    do(board, {"switch": "open_loop"})
    do(board, {"switch": "external"})
    play(board, 20)
    do(board, {"switch": "open_loop"})
    do(board, {"switch": "external", "cold": True})
    play(board, 20)
    assert begun == [0, 51, 91]


def test_it_begins_anew_when_it_takes_over_after_it_ran_away_in_shadow() -> None:
    begun: list[int] = []

    def law(x: Sample) -> float:
        if x.begins:
            begun.append(x.tick)
        return math.inf if x.tick == 19 else 0.0

    board = hosted(law)
    do(board, {"switch": "open_loop", "at_sample": 10})
    do(board, {"switch": "external", "at_sample": 20})
    play(board, 30)
    assert board.trip is None and begun == [0, 20]
    assert any("external had run away in shadow" in entry.text for entry in board.log)


def test_a_sample_begun_is_finished_by_the_next_advance() -> None:
    """A step at a time shows and asks the same as `advance` alone."""
    board, voltages = hosted(lambda _: voltages[-1]), [0.0]
    law, whole = pi(), play(hosted(pi()), 100)
    drive = []
    for _ in range(100):
        sample = board.sample()
        assert sample is not None and sample == board.sample()
        voltages.append(law(sample))
        drive.append(float(board.advance(1).outputs[0, board.signals.index("drive.voltage")]))
    assert drive == whole["drive.voltage"].tolist()


@pytest.mark.parametrize("answer", [None, "5 V", [1.0, 2.0]])
def test_an_answer_that_is_no_number_is_refused_in_one_line(answer: Any) -> None:
    with pytest.raises(InputError, match=r"^external: must answer with one number, the voltage; at sample 0 it was"):
        hosted(lambda _: answer).advance(10)


def test_no_other_bench_has_it() -> None:
    assert "external" not in registry.blocks("control") and "external" not in make(base=RICH).spec.controllers
    with pytest.raises(InputError, match=r"controller.kind: external is computed outside") as refused:
        make({"controller.kind": "external"})
    assert "--controller-process" in refused.value.hint
    for command in ({"switch": "external"}, {"set": {"controller.kind": "external"}}):
        with pytest.raises(InputError, match=r"external is not on this bench"):
            do(make(base=RICH), command)
    with pytest.raises(InputError, match="cannot be copied"):
        hosted(lambda _: 0.0).checkpoint()


@pytest.mark.parametrize(
    ("values", "field"), [({"drive.kind": "analogue"}, "drive.kind"), ({"device": {"id": "gyro-a"}}, "controller.kind")]
)
def test_a_bench_it_cannot_drive_is_refused(values: dict[str, Any], field: str) -> None:
    base = {"device": values["device"]} if "device" in values else document(values, RICH)
    with pytest.raises(InputError) as refused:
        Hosted(parse(base), lambda _: 0.0)
    assert refused.value.field == field
