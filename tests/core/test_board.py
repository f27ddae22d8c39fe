"""The board: commands at tick edges, conditions, profiles, the log, trips, and saving what happened."""

from __future__ import annotations

import hashlib
import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

from core.board.board import Board
from core.board.commands import parse_command
from core.board.spec import with_values
from core.errors import InputError
from scenarios.run import build, run
from scenarios.schema import Scenario
from tests.lab import QUIET, RICH, STORY, do, document, inject, inner_digest, make, play, run_digest

FAST = {"reference.frequency_hz": 2000.0}


def fault(name: str, severity: float, **rest: Any) -> dict[str, Any]:
    return {"kind": "inject", "fault": name, "severity": severity, **rest}


# -- when commands take effect


@pytest.mark.parametrize("moment", [{"at_sample": 50}, {"at_ms": 0.5}, {"at_ms": 0.5049}, {"at_ms": 0.4951}])
def test_a_fault_takes_effect_at_its_tick(moment):
    healthy = play(make(FAST), 100)
    trace = play(make(FAST, [fault("stiffness", 0.5, **moment)]), 100)
    assert np.array_equal(trace["faults.stiffness"], np.r_[np.zeros(50), np.full(50, 0.5)])
    assert np.array_equal(trace["effects.stiffness_scale"], np.r_[np.ones(50), np.full(50, 1.5)])
    same = trace["plant.displacement"] == healthy["plant.displacement"]
    assert np.all(same[:51]) and not np.any(same[51:])


def test_a_parameter_takes_effect_at_its_tick():
    command = {"kind": "set", "values": {"reference.amplitude_v": 3.0, "sensor.noise_um": 0.5}, "at_sample": 70}
    trace, plain = play(make(FAST, [command]), 100), play(make(FAST), 100)
    np.testing.assert_allclose(trace["reference.voltage"][70:], 0.3 * plain["reference.voltage"][70:], rtol=1e-14)
    assert np.array_equal(trace["reference.voltage"][:70], plain["reference.voltage"][:70])
    noise = trace["sensor.displacement"] - trace["plant.displacement"]
    assert not noise[:70].any() and noise[70:].all()


def test_commands_of_one_tick_take_effect_in_the_order_given():
    commands = [
        fault("added_mass", 0.1, at_sample=10),
        {"kind": "heal", "faults": ["added_mass"], "at_sample": 20},
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


# -- severity over time


@pytest.mark.parametrize("name", ["added_mass", "stiffness", "damping"])
def test_ramp_is_exact_to_the_sample(name):
    profile = {"kind": "ramp", "duration_ms": 0.37}
    trace = play(make(FAST, [fault(name, 0.8, profile=profile, at_sample=21)]), 100)
    expected = np.clip((np.arange(100) - 21) / 37, 0, 1) * 0.8
    np.testing.assert_allclose(trace[f"faults.{name}"], expected, atol=1e-15)
    scale = {"added_mass": "mass"}.get(name, name)
    np.testing.assert_allclose(trace[f"effects.{scale}_scale"], 1 + expected, atol=1e-15)


def test_intermittent_is_exact_to_the_sample():
    profile = {"kind": "intermittent", "period_ms": 0.10, "duty": 0.3}
    trace = play(make(FAST, [fault("stiffness", -0.2, profile=profile, at_sample=13)]), 80)
    expected = [-0.2 if i >= 13 and (i - 13) % 10 < 3 else 0.0 for i in range(80)]
    assert trace["faults.stiffness"].tolist() == expected


@pytest.mark.parametrize("name", ["added_mass", "stiffness", "damping"])
@pytest.mark.parametrize("profile", ["step", "ramp", "intermittent"])
def test_severity_zero_is_bit_for_bit_no_fault(name, profile):
    plain = make({}, base=RICH)
    board = make({}, [fault(name, 0.0, profile={"kind": profile}, at_sample=11)], base=RICH)
    assert run_digest(board, 300) == run_digest(plain, 300)


def test_a_healed_device_is_the_nominal_one_again():
    board = make(FAST)
    inject(board, added_mass=0.2, stiffness=0.1, damping=3.0)
    do(board, fault("damping", 0.5, profile={"kind": "ramp", "duration_ms": 1.0}))
    play(board, 50)
    do(board, {"kind": "heal", "faults": ["damping"]})
    trace = play(board, 1)
    assert [trace[f"faults.{name}"][0] for name in ("added_mass", "stiffness", "damping")] == [0.2, 0.1, 0.0]
    do(board, {"kind": "heal"})
    play(board, 2000)
    assert board.value("effects.mass_scale") == 1.0 and not board.faults
    late, plain = play(board, 500), make(FAST)
    play(plain, 2051)
    np.testing.assert_allclose(late["plant.displacement"], play(plain, 500)["plant.displacement"], atol=1e-9)


def test_two_faults_act_together():
    board = make(FAST)
    inject(board, added_mass=0.2, stiffness=0.1)
    play(board, 2)
    assert board.value("effects.mass_scale") == 1.2 and board.value("effects.stiffness_scale") == 1.1


# -- what is refused


REFUSED: list[tuple[dict[str, Any], str, str]] = [
    (fault("added_mass", 0.1), "fault", "conflict"),
    (fault("nothing", 0.1), "fault", "unknown"),
    (fault("stiffness", -0.95), "severity", "invalid"),
    (fault("stiffness", 21.0), "severity", "invalid"),
    (fault("stiffness", 0.1, profile={"kind": "saw"}), "profile.kind", "invalid"),
    (fault("stiffness", 0.1, profile={"kind": "ramp", "duration_ms": 0}), "profile.duration_ms", "invalid"),
    (fault("stiffness", 0.1, at_sample=-1), "at_sample", "invalid"),
    (fault("stiffness", 0.1, at_sample=500, at_ms=7.0), "", "invalid"),
    ({"kind": "inject", "fault": "stiffness"}, "severity", "invalid"),
    (fault("stiffness", math.nan), "severity", "invalid"),
    (fault("stiffness", 0.1, strength=2), "strength", "unknown"),
    ({"kind": "heal", "faults": ["damping"]}, "faults", "conflict"),
    ({"kind": "heal", "faults": ["added_mass", "damping"]}, "faults", "conflict"),
    ({"kind": "heal", "faults": ["nothing"]}, "faults", "unknown"),
    ({"kind": "switch", "controller": "nothing"}, "controller", "unknown"),
    ({"kind": "switch", "controller": "open_loop"}, "controller", "conflict"),
    ({"kind": "set", "values": {}}, "values", "invalid"),
    ({"kind": "set", "values": {"controller.kind": "nothing"}}, "controller.kind", "unknown"),
    ({"kind": "set", "values": {"controllers.mrac.filter_pole": 2.0}}, "controllers.mrac.filter_pole", "not_live"),
    ({"kind": "set", "values": {"sample_rate_khz": 50}}, "sample_rate_khz", "not_live"),
    ({"kind": "set", "values": {"seed": 9}}, "seed", "not_live"),
    ({"kind": "set", "values": {"device.mass_kg": 1e-10}}, "device", "not_live"),
    ({"kind": "set", "values": {"plant.initial_displacement_um": 1.0}}, "plant.initial_displacement_um", "not_live"),
    ({"kind": "set", "values": {"diagnosers.kalman.every": 2}}, "diagnosers.kalman.every", "not_live"),
    ({"kind": "set", "values": {"diagnosers.other.kind": "mmae"}}, "diagnosers", "not_live"),
    ({"kind": "set", "values": {"drive.kind": "analogue"}}, "drive.kind", "not_live"),
    ({"kind": "set", "values": {"plant.drive": "analogue"}}, "drive.kind", "not_live"),
    ({"kind": "set", "values": {"sensor.noise_um": -1.0}}, "sensor.noise_um", "invalid"),
    ({"kind": "set", "values": {"sensor.noise_um": "much"}}, "sensor.noise_um", "invalid"),
    ({"kind": "set", "values": {"sensor.noise_nm": 1.0}}, "sensor.noise_nm", "unit"),
    ({"kind": "set", "values": {"sensor.noise_um": 0.3, "sensor.colour": 1}}, "sensor.colour", "unknown"),
    ({"kind": "set", "values": {"nothing.at_all": 1}}, "nothing", "unknown"),
    ({"kind": "reset_trip"}, "kind", "conflict"),
    ({"kind": "explode"}, "kind", "unknown"),
    ({}, "kind", "unknown"),
]


@pytest.mark.parametrize(("command", "field", "code"), REFUSED, ids=[str(c)[:70] for c, *_ in REFUSED])
def test_a_refused_command_changes_nothing(command, field, code):
    board, twin = make({}, base=RICH), make({}, base=RICH)
    for one in (board, twin):
        inject(one, added_mass=0.1)
        play(one, 40)
    before = inner_digest(board), board.digest(), len(board.log), dict(board.faults), board.spec
    with pytest.raises(InputError) as error:
        do(board, command)
    assert (inner_digest(board), board.digest(), len(board.log), dict(board.faults), board.spec) == before
    assert error.value.field == field, str(error.value)
    assert error.value.code == code, str(error.value)
    assert "\n" not in str(error.value) and len(str(error.value)) < 1000
    assert set(error.value.as_dict()) == {"code", "message", "field", "hint"}
    assert run_digest(board, 200) == run_digest(twin, 200)


@pytest.mark.parametrize(
    "command", [fault("added_mass", 50.0, at_sample=90), {"kind": "switch", "controller": "x", "at_ms": 9.0}]
)
def test_a_command_for_later_that_can_never_work_is_refused_now(command):
    board = make(FAST)
    with pytest.raises(InputError):
        do(board, command)
    assert not board.pending and not board.log


def test_a_command_for_later_that_no_longer_fits_is_refused_then():
    board = make(
        FAST, [fault("added_mass", 0.1, at_sample=10), {"kind": "heal", "faults": ["damping"], "at_sample": 20}]
    )
    expected = run_digest(make(FAST, [fault("added_mass", 0.1, at_sample=10)]), 60)
    assert run_digest(board, 60) == expected
    entry = board.log[-1]
    assert (entry.kind, entry.tick, entry.actor) == ("refused", 20, "board") and "damping" in entry.text


def test_a_fault_may_change_its_severity():
    board = make(FAST)
    inject(board, stiffness=0.1)
    entry = do(board, fault("stiffness", 0.2))
    assert entry.old["severity"] == 0.1 and entry.new["severity"] == 0.2
    assert play(board, 1)["faults.stiffness"][0] == 0.2
    do(board, fault("stiffness", 0.2, profile={"kind": "ramp"}))
    assert play(board, 1)["faults.stiffness"][0] == 0.0


@pytest.mark.parametrize(
    ("values", "path", "old"),
    [
        ({"reference.amplitude_v": 3.0}, "reference.amplitude_v", 10.0),
        ({"sensor.noise_um": 0.1}, "sensor.noise_um", 0.0),
        ({"controllers.mrac.adaptation_gain": 0.1}, "controllers.mrac.adaptation_gain", 1.0),
        ({"controllers.pid.pole": 1.1}, "controllers.pid.pole", 1.3),
        ({"drive.limit_v": 5.0}, "drive.limit_v", 30.0),
        ({"guard.travel_um": 9.0}, "guard.travel_um", 25.0),
        ({"plant.thermal_noise": True}, "plant.thermal_noise", False),
        ({"reference.kind": "square"}, "reference.kind", "sine"),
        ({"plant.model": "nonlinear"}, "plant.model", "linear"),
        ({"controller.kind": "pid"}, "controller.kind", "open_loop"),
    ],
)
def test_live_parameters_change_and_the_log_knows_the_old_value(values, path, old):
    board = make()
    play(board, 30)
    entry = do(board, {"kind": "set", "values": values})
    assert entry.old == {path: old} and entry.new == values and entry.tick == 30
    assert run_digest(board, 200) != run_digest(make(), 230) or path in (
        "controllers.mrac.adaptation_gain",
        "controllers.pid.pole",
        "guard.travel_um",
        "drive.limit_v",
    )


def test_commands_leave_their_values_alone():
    table = {"kind": "sine", "amplitude_v": 1.0}
    values = {"reference": table, "reference.amplitude_v": 2.0, "controllers": {"pid": {}}, "controllers.pid.pole": 1.0}
    with_values(document(), values)
    assert table == {"kind": "sine", "amplitude_v": 1.0} and values["controllers"] == {"pid": {}}
    board = make()
    do(board, {"kind": "set", "values": values})
    assert table["amplitude_v"] == 1.0
    assert play(board, 101)["reference.voltage"].max() == pytest.approx(2.0, rel=1e-6)


# -- the log and the digest


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
        assert entry["time_ms"] == pytest.approx(entry["tick"] * 0.01)
        assert entry["text"] and "\n" not in entry["text"]


def test_the_order_of_the_log_does_not_depend_on_chunks():
    def told(chunk: int) -> list[tuple[int, str]]:
        board = make({}, [fault("added_mass", 0.05, at_sample=30)], base=RICH)
        while board.tick < 300:
            board.advance(chunk)
        return [(entry.tick, entry.text) for entry in board.log]

    assert told(1) == told(300)


def test_digest_is_the_hash_of_the_outputs():
    scenario = Scenario.load({**document({}, RICH), "samples": 1500, "events": [{"at_sample": 9, "switch": "pid"}]})
    result = run(scenario)
    assert result.outputs.dtype == np.float64
    assert result.digest == hashlib.sha256(np.ascontiguousarray(result.outputs).tobytes()).hexdigest()
    names = [signal.name for signal in result.board.signals if signal.kind == "output"]
    assert names == result.board.signals.names[: result.outputs.shape[1]]


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


# -- drive and guard


def test_drive_clips_and_rounds():
    values = {**FAST, "drive.limit_v": 6.0, "drive.quantum_v": 0.5}
    trace = play(make(values), 200)
    expected = np.floor(np.clip(trace["open_loop.voltage"], -6, 6) / 0.5 + 0.5) * 0.5
    assert np.array_equal(trace["drive.voltage"], expected)
    assert np.array_equal(trace["drive.saturated"], (np.abs(trace["open_loop.voltage"]) > 6).astype(float))


def test_sensor_rounds_and_clips():
    values = {**FAST, "sensor": {"kind": "ideal", "noise_um": 0.0, "quantum_um": 0.25, "range_um": 1.5}}
    trace = play(make(values), 400)
    expected = np.clip(np.floor(trace["plant.displacement"] / 0.25 + 0.5) * 0.25, -1.5, 1.5)
    assert np.array_equal(trace["sensor.displacement"], expected)
    assert np.abs(trace["plant.displacement"]).max() > 2


def test_the_rail_trips_after_its_time():
    values = {"reference": {"kind": "step", "amplitude_v": 40.0, "start_ms": 0.5}, "guard.rail_ms": 0.2}
    board = make({**values, "device.stiffness_n_m": 1.0})
    trace = play(board, 1000)
    assert board.trip is not None and board.trip.signal == "drive.voltage"
    assert len(trace["drive.voltage"]) == 50 + 20 + 1, "20 ticks are allowed, the next is not"


def test_travel_trips_on_the_true_displacement():
    board = make({"reference": {"kind": "constant", "amplitude_v": 29.0}, "guard.travel_um": 12.0})
    trace = play(board, 1000)
    x = np.abs(trace["plant.displacement"])
    assert board.trip is not None and board.trip.signal == "plant.displacement"
    assert np.all(x[:-1] <= 12.0) and x[-1] > 12.0
    assert board.trip.tick == board.tick == len(x)
    assert board.log[-1].kind == "tripped" and board.log[-1].actor == "board"
    assert board.trip.value == trace["plant.displacement"][-1]


def test_reset_starts_blocks_anew_and_keeps_faults_time_and_scores():
    board = make({**RICH, "guard": {"travel_um": 3.0}, "reference.amplitude_v": 9.0}, base=QUIET)
    inject(board, stiffness=0.3)
    play(board, 3000)
    assert board.trip is not None
    tick, steps = board.tick, board.scores()["kalman"].delays
    do(board, {"kind": "set", "values": {"reference.amplitude_v": 1.0}})
    do(board, {"kind": "reset_trip"})
    assert board.tick == tick and board.scores()["kalman"].delays == steps
    trace = play(board, 300)
    assert board.trip is None
    assert abs(trace["plant.displacement"][0]) < 0.05 and np.all(trace["faults.stiffness"] == 0.3)


# -- saving and running again


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
    st.just({"kind": "heal"}),
    st.builds(
        lambda name, cold: {"kind": "switch", "controller": name, "cold": cold},
        st.sampled_from(["open_loop", "pid", "mrac"]),
        st.booleans(),
    ),
    st.builds(
        lambda values: {"kind": "set", "values": values},
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
    st.just({"kind": "reset_trip"}),
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
    do(board, {"kind": "set", "values": {"reference.amplitude_v": 0.1}})
    play(board, 400)
    assert board.pending and not board.faults
    assert run(Scenario.load(board.save())).digest == board.digest()


def test_a_saved_bench_with_a_trip_and_a_reset():
    board = make({"controller": {"kind": "mrac", "adaptation_gain": 30.0}})
    inject(board, stiffness=1.0)
    play(board, 2000)
    assert board.trip is not None
    do(board, {"kind": "set", "values": {"controllers.mrac.adaptation_gain": 1.0}})
    do(board, {"kind": "reset_trip"})
    play(board, 777)
    do(board, {"kind": "switch", "controller": "pid"})
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
    for command in (None, [], "inject", {"kind": ["inject"]}, {"kind": None}):
        with pytest.raises(InputError):
            parse_command(command)


def test_boards_do_not_share_anything():
    first, second = make({}, base=RICH), make({}, base=RICH)
    a, b = [], []
    for board, digests in itertools.islice(itertools.cycle([(first, a), (second, b)]), 10):
        digests.append(run_digest(board, 37))
    assert a == b
