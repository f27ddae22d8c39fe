"""Refused commands change nothing; live parameters may change while running."""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.board.document import with_values
from core.errors import InputError
from scenarios.edit import with_values as with_scenario_values
from scenarios.library import get
from scenarios.run import build
from tests.lab import RICH, do, document, fault, inject, inner_digest, make, play, run_digest

FAST = {"reference.frequency_hz": 2000.0}


REFUSED: list[tuple[dict[str, Any], str, str]] = [
    (fault("added_mass", 0.1), "fault", "conflict"),
    (fault("nothing", 0.1), "fault", "unknown"),
    (fault("stiffness", -0.95), "severity", "invalid"),
    (fault("stiffness", 21.0), "severity", "invalid"),
    (fault("stiffness", 0.1, profile={"kind": "saw"}), "profile.kind", "invalid"),
    (fault("stiffness", 0.1, profile={"kind": "ramp", "duration_ms": 0}), "profile.duration_ms", "invalid"),
    (fault("stiffness", 0.1, at_sample=-1), "at_sample", "invalid"),
    (fault("stiffness", 0.1, at_sample=500, at_ms=7.0), "", "invalid"),
    ({"fault": "stiffness"}, "severity", "invalid"),
    (fault("stiffness", math.nan), "severity", "invalid"),
    (fault("stiffness", 0.1, strength=2), "strength", "unknown"),
    ({"heal": ["damping"]}, "heal", "conflict"),
    ({"heal": ["added_mass", "damping"]}, "heal", "conflict"),
    ({"heal": ["nothing"]}, "heal", "unknown"),
    ({"switch": "nothing"}, "switch", "unknown"),
    ({"switch": "open_loop"}, "switch", "conflict"),
    ({"switch": "drive_loop"}, "switch", "invalid"),  # for a gyroscope
    ({"set": {"controller.kind": "drive_loop"}}, "controller.kind", "invalid"),
    ({"set": {}}, "set", "invalid"),
    ({"set": {"controller.kind": "nothing"}}, "controller.kind", "unknown"),
    ({"set": {"controllers.mrac.filter_pole": 2.0}}, "controllers.mrac.filter_pole", "not_live"),
    ({"set": {"sample_rate_khz": 50}}, "sample_rate_khz", "not_live"),
    ({"set": {"seed": 9}}, "seed", "not_live"),
    ({"set": {"device.mass_kg": 1e-10}}, "device", "not_live"),
    ({"set": {"plant.initial_displacement_um": 1.0}}, "plant.initial_displacement_um", "not_live"),
    ({"set": {"diagnosers.kalman.every": 2}}, "diagnosers.kalman.every", "not_live"),
    ({"set": {"diagnosers.other.kind": "mmae"}}, "diagnosers", "not_live"),
    ({"set": {"drive.kind": "analogue"}}, "drive.kind", "not_live"),
    ({"set": {"plant.drive": "analogue"}}, "plant.drive", "not_live"),
    ({"set": {"controller.kind": "mrac", "controller.filter_pole": 2.0}}, "controller.filter_pole", "not_live"),
    ({"set": {"sensor.every": 2}}, "sensor.every", "not_live"),
    ({"set": {"sensor.noise_um": -1.0}}, "sensor.noise_um", "invalid"),
    ({"set": {"sensor.noise_um": "much"}}, "sensor.noise_um", "invalid"),
    ({"set": {"sensor.noise_nm": 1.0}}, "sensor.noise_nm", "unit"),
    ({"set": {"sensor.noise_um": 0.3, "sensor.colour": 1}}, "sensor.colour", "unknown"),
    ({"set": {"nothing.at_all": 1}}, "nothing", "unknown"),
    ({"reset_trip": True}, "reset_trip", "conflict"),
    ({"kind": "explode"}, "kind", "unknown"),
    ({}, "", "invalid"),
    ({"heal": "all", "switch": "pid"}, "switch", "invalid"),
    ({"heal": "all", "cold": True}, "cold", "invalid"),
    ({"heal": None}, "", "invalid"),
    ({"reset_trip": False}, "", "invalid"),
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


@pytest.mark.parametrize("command", [fault("added_mass", 50.0, at_sample=90), {"switch": "x", "at_ms": 9.0}])
def test_a_command_for_later_that_can_never_work_is_refused_now(command):
    board = make(FAST)
    with pytest.raises(InputError):
        do(board, command)
    assert not board.pending and not board.log


def test_a_command_for_later_that_no_longer_fits_is_refused_then():
    board = make(FAST, [fault("added_mass", 0.1, at_sample=10), {"heal": ["damping"], "at_sample": 20}])
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
    entry = do(board, {"set": values})
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
    do(board, {"set": values})
    assert table["amplitude_v"] == 1.0
    assert play(board, 101)["reference.voltage"].max() == pytest.approx(2.0, rel=1e-6)


@pytest.mark.parametrize(
    ("command", "field"),
    [
        ({"switch": "mrac"}, "switch"),
        ({"set": {"slots.drive": "mrac"}}, "slots.drive"),
        ({"set": {"controllers.mrac.adaptation_gain": 2.0}}, "controllers.mrac"),
        ({"set": {"controllers.mrac": {"adaptation_gain": 2.0}}}, "controllers.mrac"),
        ({"set": {"sensors.ideal.noise_um": 0.1}}, "sensors.ideal"),
    ],
)
def test_a_gyroscope_takes_no_controller_of_one_displacement(command, field):
    board = build(get("gyro-adaptive"))
    with pytest.raises(InputError, match="is for one displacement; gyroscope moves along x, y") as refused:
        do(board, command)
    assert refused.value.field == field and "mrac" not in board.spec.controllers


def test_a_scenario_has_no_parameters_of_a_controller_that_its_plant_cannot_have():
    with pytest.raises(InputError, match="is for one displacement; gyroscope moves along x, y") as refused:
        build(with_scenario_values(get("gyro-adaptive"), {"controllers.mrac.adaptation_gain": 2.0}))
    assert refused.value.field == "controllers.mrac"
    with pytest.raises(InputError, match="needs x, y; linear has one displacement") as refused:
        make({"controllers.adaptive_rate.adaptation_gain": 2.0})
    assert refused.value.field == "controllers.adaptive_rate"


def test_a_parameter_of_a_controller_that_does_not_suit_the_device_is_unknown():
    board = build(with_scenario_values(get("ch4-regulator"), {"controllers.stvsc.filter_pole": 2.0}))
    assert "stvsc" not in board.spec.controllers  # it is for plants of second order
    with pytest.raises(InputError, match=r"^controllers\.stvsc: unknown controller 'stvsc'; allowed: ") as refused:
        do(board, {"set": {"controllers.stvsc.filter_pole": 3.0}})
    assert refused.value.code == "unknown" and not board.log
    bound = {"controllers.vsmrc.reference_bound": 0.25}
    assert do(board, {"set": bound}).new == bound
