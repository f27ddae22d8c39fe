"""The environment on the board: it changes the true device, live and by leaks, and nothing at 300 K and 1 atm."""

from __future__ import annotations

import numpy as np
import pytest

from core.errors import InputError
from tests.lab import RICH, do, make, play

RING = {"plant.initial_displacement_um": 4.0, "reference.amplitude_v": 0.0}
K, M, B = 0.0538, 2.2090e-10, 7.09e-7


def decay_per_cycle(x, per_cycle):
    """Logarithmic decrement from the largest value of each cycle."""
    tops = [np.max(np.abs(x[i : i + per_cycle])) for i in range(0, len(x) - per_cycle, per_cycle)]
    return np.mean(-np.diff(np.log(tops[:6])))


def test_default_changes_no_bit():
    plain, told = make(), make({"environment": {"temperature_k": 300.0, "pressure_pa": 101325.0, "humidity_pct": 90.0}})
    play(plain, 500), play(told, 500)
    assert plain.digest() == told.digest()


def test_a_vacuum_rings_longer_and_the_controllers_do_not_know():
    board = make({**RING, "environment.pressure_pa": 1000.0, "sample_rate_khz": 1000})
    x = play(board, 6000)["plant.displacement"]
    omega = np.sqrt(K / M)
    q = np.pi / decay_per_cycle(x, round(2 * np.pi / omega * 1e6))
    assert q == pytest.approx(35, rel=0.1)
    assert board.value("effects.damping_scale") == pytest.approx(0.138, rel=0.01)
    assert board.spec.context().device.damping == pytest.approx(B * 1e3)


def test_temperature_is_live_and_moves_the_displacement_at_rest():
    board = make({"reference": {"kind": "constant", "amplitude_v": 5.0}})
    play(board, 2000)
    cold = board.value("plant.displacement")
    do(board, {"set": {"environment.temperature_k": 400.0}})
    play(board, 2000)
    assert board.value("plant.displacement") / cold == pytest.approx(1 / (1 - 63e-6 * 100), rel=1e-9)
    assert board.log[-1].old == {"environment.temperature_k": 300.0}
    do(board, {"set": {"environment.temperature_k": 300.0}})
    play(board, 2000)
    assert board.value("effects.stiffness_scale") == 1.0
    assert board.value("plant.displacement") == pytest.approx(cold, rel=1e-9)


def test_a_leak_brings_the_air_back():
    board = make({"environment.pressure_pa": 10.0})
    play(board, 10)
    assert board.value("environment.pressure") == 10.0
    assert 4.8623 / board.value("effects.damping_scale") == pytest.approx(2400, rel=0.02)
    ramp = {"kind": "ramp", "duration_ms": 2.0}
    do(board, {"fault": "vacuum_loss", "severity": 1.0, "profile": ramp})
    seen = play(board, 300)
    air, damping = seen["environment.pressure"], seen["effects.damping_scale"]
    assert air[100] == pytest.approx(10 + 99 / 200 * (101325 - 10), rel=1e-6)
    assert np.all(np.diff(damping) >= 0) and damping[-1] == 1.0 and air[-1] == 101325.0
    do(board, {"heal": ["vacuum_loss"]})
    play(board, 10)
    assert board.value("environment.pressure") == 10.0


def test_a_leak_in_the_open_does_nothing():
    plain, leaking = make(), make()
    do(leaking, {"fault": "vacuum_loss", "severity": 1.0})
    a, b = play(plain, 300), play(leaking, 300)
    assert np.array_equal(a["plant.displacement"], b["plant.displacement"])


def test_faults_multiply_what_the_environment_makes_of_the_device():
    board = make({"environment.pressure_pa": 1000.0, "environment.temperature_k": 350.0})
    play(board, 2)
    alone = {name: board.value(f"effects.{name}") for name in ("stiffness_scale", "damping_scale")}
    do(board, {"fault": "damping", "severity": 0.5})
    do(board, {"fault": "ageing", "severity": 4.0})
    play(board, 2)
    assert board.value("effects.damping_scale") == pytest.approx(1.5 * alone["damping_scale"], rel=1e-12)
    assert board.value("effects.stiffness_scale") == pytest.approx(alone["stiffness_scale"] / 0.572, rel=1e-9)


def test_ageing_takes_42_8_percent_of_the_displacement():
    board = make({"reference": {"kind": "constant", "amplitude_v": 5.0}})
    play(board, 2000)
    new = board.value("plant.displacement")
    do(board, {"fault": "ageing", "severity": 4.0})
    play(board, 2000)
    assert board.value("plant.displacement") / new == pytest.approx(0.572, rel=1e-6)


def test_thermal_noise_follows_air_and_temperature():
    """Fluctuation and dissipation: less damping, less force, the same mean square at the same temperature."""
    still = {"reference.amplitude_v": 0.0, "plant.thermal_noise": True, "sample_rate_khz": 50}
    x = play(make({**still, "environment.pressure_pa": 3000.0}), 100_000)["plant.displacement"]
    assert np.sqrt(np.mean(x[5000:] ** 2)) * 1e3 == pytest.approx(0.2775, rel=0.06)


def test_humidity_shows_as_adhesion_only():
    dry, wet = make({"environment.humidity_pct": 10.0}), make({"environment.humidity_pct": 90.0})
    a, b = play(dry, 50), play(wet, 50)
    assert a["environment.adhesion"][-1] < 0.05 < 10 < b["environment.adhesion"][-1]
    assert np.array_equal(a["plant.displacement"], b["plant.displacement"])


@pytest.mark.parametrize(
    ("values", "field"),
    [
        ({"environment.pressure_pa": 0.0}, "environment.pressure_pa"),
        ({"environment.temperature_c": 20.0}, "environment.temperature_c"),
        ({"environment.humidity_pct": 101.0}, "environment.humidity_pct"),
    ],
)
def test_what_is_no_air_is_refused(values, field):
    with pytest.raises(InputError) as error:
        make(values)
    assert error.value.field == field


def dead_band(volts: float, *, fault: float = 0.0, **environment: float) -> bool:
    """Whether a voltage from rest moves the shuttle: F/k over 0.6018 um/V, 20 nN are 0.618 V."""
    board = make({"reference": {"kind": "constant", "amplitude_v": volts}, "environment": environment})
    if fault:
        do(board, {"fault": "stiction", "severity": fault})
    return abs(play(board, 400)["plant.displacement"][-1]) > 0.0


@pytest.mark.parametrize("how", ["environment", "fault"])
def test_friction_has_a_dead_band_that_grows_with_humidity(how):
    """|F_e| = 3.238e-8 N/V; friction goes with the adhesion energy W = 0.03 (50/0.03)^(1/(1+exp(-(H-60)/8))) mJ/m^2."""
    own = {"friction_nn": 20.0} if how == "environment" else {"fault": 20.0}

    def energy(humidity):
        return 0.03 * (50 / 0.03) ** (1 / (1 + np.exp(-(humidity - 60) / 8)))

    per_volt = make().spec.device.signed_force_n_per_v
    for humidity in (0.0, 40.0, 50.0, 60.0):
        edge = 20e-9 * energy(humidity) / energy(40.0) / abs(per_volt)
        assert not dead_band(0.99 * edge, humidity_pct=humidity, **own)
        assert dead_band(1.01 * edge, humidity_pct=humidity, **own)


def test_friction_and_humidity_are_live():
    board = make({"environment.friction_nn": 20.0}, base=RICH)
    play(board, 400)
    assert board.value("kalman.truth") == -1 and board.value("effects.friction") == 0.02
    do(board, {"set": {"environment.humidity_pct": 80.0, "environment.friction_nn": 40.0}})
    play(board, 1)
    assert board.value("effects.friction") > 10.0  # it sticks for good
    x = play(board, 400)["plant.displacement"]
    assert np.all(x[50:] == x[50])
    do(board, {"set": {"environment.friction_nn": 0.0}})
    assert np.ptp(play(board, 400)["plant.displacement"]) > 1.0 and board.value("kalman.truth") == 0


def test_age_is_live_and_a_fault_goes_on_from_it():
    board = make({"reference": {"kind": "constant", "amplitude_v": 5.0}})
    play(board, 2000)
    new = board.value("plant.displacement")
    for weeks, fault in ((4.0, 0.0), (1.5, 2.5), (0.0, 4.0)):
        do(board, {"set": {"environment.age_weeks": weeks}})
        if fault:
            do(board, {"fault": "ageing", "severity": fault})
        play(board, 2000)
        assert board.value("plant.displacement") / new == pytest.approx(0.572, rel=1e-6)
