"""The shuttle against closed forms: decay, response, force, energy, friction, stops, heat."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from scipy import linalg, signal, special

from core.block import Oscillator
from core.device.response import held_response
from tests.lab import inject, make, phasor, play, rms

M, BETA, K = 2.2090e-10, 7.09e-7, 0.0538
W0 = math.sqrt(K / M)
SIGMA = BETA / (2 * M)
WD = math.sqrt(W0**2 - SIGMA**2)
STILL = {"reference": {"kind": "constant", "amplitude_v": 0.0}}
LCR = {"device": {"id": "lcr-350"}}


def continuous(gain_um_per_v: float, mass=M, damping=BETA, stiffness=K):
    """State space of the device in um, ms, V."""
    a = np.array([[0.0, 1.0], [-stiffness / mass * 1e-6, -damping / mass * 1e-3]])
    b = np.array([[0.0], [gain_um_per_v * stiffness / mass * 1e-6]])
    return a, b


def held_model(gain: float, dt: float):
    a, b = continuous(gain)
    block = linalg.expm(np.block([[a, b], [np.zeros((1, 3))]]) * dt)
    return block[:2, :2], block[:2, 2]


# -- free decay


@pytest.mark.parametrize("plant", ["linear", "nonlinear"])
def test_free_decay(plant):
    values = {**STILL, "plant.model": plant, "plant.initial_displacement_um": 4.0, "sample_rate_khz": 1000}
    if plant == "nonlinear":
        values["plant.cubic_n_m3"] = 0.0
    x = play(make(values), 2000)["plant.displacement"]
    t = np.arange(len(x)) * 1e-3
    rising = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))
    zeros = t[rising] - x[rising] * 1e-3 / (x[rising + 1] - x[rising])
    assert np.diff(zeros) == pytest.approx(2e3 * math.pi / WD, rel=1e-3)
    assert np.diff(zeros).mean() == pytest.approx(0.40476, rel=1e-3)
    tops = np.array([x[a:b].max() for a, b in itertools.pairwise(rising)])
    decrement = np.log(tops[:-1] / tops[1:])
    assert decrement == pytest.approx(2 * math.pi * SIGMA / WD, rel=1e-3)
    assert decrement.mean() == pytest.approx(0.6496, rel=5e-3)
    exact = 4 * np.exp(-SIGMA * t * 1e-3) * (np.cos(WD * t * 1e-3) + SIGMA / WD * np.sin(WD * t * 1e-3))
    np.testing.assert_allclose(x, exact, atol=1e-12 if plant == "linear" else 1e-9)


# -- records


def voltages() -> np.ndarray:
    t = np.arange(5003)
    return 5.0 * np.sin(0.11 * t) + np.sign(np.sin(0.013 * t)) - 0.3


DEVICE = Oscillator(
    mass=M * 1e6, damping=BETA * 1e3, stiffness=K, force=-4e6 * 24 * 8.8541878128e-12 * (2.0 / 2.1) * 20.0
)


@pytest.mark.parametrize("length", [0, 1, 2, 3, 4, 5, 8, 5003])
def test_held_response_against_lsim_and_lfilter(length):
    u = voltages()[:length]
    found = held_response(DEVICE, u, 0.01)
    assert found.shape == (length,)
    if length < 2:
        assert not found.any()
        return
    a, b = continuous(DEVICE.static_gain)
    c, d = np.array([[1.0, 0.0]]), np.zeros((1, 1))
    scale = np.abs(found).max() or 1.0
    _, y, _ = signal.lsim((a, b, c, d), u, np.arange(length) * 0.01, interp=False)
    np.testing.assert_allclose(found / scale, np.atleast_1d(y) / scale, atol=1e-12)
    numerator, denominator, _ = signal.cont2discrete(
        ([DEVICE.force / DEVICE.mass], [1.0, DEVICE.damping / DEVICE.mass, DEVICE.stiffness / DEVICE.mass]), 0.01
    )
    np.testing.assert_allclose(found / scale, signal.lfilter(numerator[0], denominator, u) / scale, atol=1e-11)


def test_the_plant_is_the_record_of_the_voltage_it_was_given():
    trace = play(make({"reference": {"kind": "prbs", "amplitude_v": 7.0}}), 3000)
    expected = held_response(DEVICE, trace["drive.voltage"], 0.01)
    np.testing.assert_allclose(trace["plant.displacement"], expected, atol=1e-12)


# -- force


def test_reference_device_gives_the_figures_of_its_response():
    values = {**LCR, "plant.drive": "analogue", "reference": {"kind": "sine", "amplitude_v": 3.0, "frequency_hz": 2e3}}
    x = play(make(values), 4000)["plant.displacement"][2000:]
    found = phasor(x, 2000.0, 0.01, 2000)
    assert abs(found) == pytest.approx(4.210, rel=5e-3)
    assert math.degrees(math.atan2(found.imag, found.real)) == pytest.approx(180 - 25.22, abs=0.3)
    h = 1 / (1 - (2 * math.pi * 2e3 / W0) ** 2 + 2j * SIGMA * 2 * math.pi * 2e3 / W0**2)
    assert abs(h) == pytest.approx(2.5729, rel=1e-3)


@pytest.mark.parametrize("volts", [1.0, -1.0, 4.0])
@pytest.mark.parametrize("plant", ["linear", "nonlinear"])
def test_positive_voltage_pulls_to_negative_x(plant, volts):
    values = {**LCR, "plant.model": plant, "reference": {"kind": "constant", "amplitude_v": volts}}
    if plant == "nonlinear":
        values["plant.cubic_n_m3"] = 0.0
    x = play(make(values), 3000)["plant.displacement"][-1]
    assert x == pytest.approx(-0.5455 * volts, rel=2e-3)
    # half the capacitance gradient times the difference of the squares of the voltages, over the stiffness
    gradient = 2 * 87 * 8.8541878128e-12 * 2.0 / 2.1
    force = 0.5 * gradient * ((10 - volts) ** 2 - (-10 - volts) ** 2)
    assert x == pytest.approx(force / 0.0538 * 1e6, rel=1e-3)


@pytest.mark.parametrize("plant", ["linear", "nonlinear"])
def test_identical_voltages_on_both_stators_move_nothing(plant):
    values = {**LCR, "device.opposite_bias_v": 10.0, "plant.model": plant, "reference.amplitude_v": 30.0}
    trace = play(make({**values, "reference.kind": "sine"}), 2000)
    assert np.abs(trace["drive.voltage"]).max() > 25
    assert np.abs(trace["plant.displacement"]).max() < 1e-6  # 1 pm


def test_unequal_stators_move_the_shuttle_without_any_drive():
    x = play(make({**LCR, **STILL, "device.opposite_bias_v": -4.0}), 3000)["plant.displacement"][-1]
    gradient = 2 * 87 * 8.8541878128e-12 * 2.0 / 2.1
    assert x == pytest.approx(0.5 * gradient * (10**2 - 4**2) / 0.0538 * 1e6, rel=1e-3)


def test_held_and_analogue_drive_each_match_their_own_closed_form():
    n, dt, volts = 1500, 0.01, 10.0
    values = {"reference": {"kind": "sine", "amplitude_v": volts, "frequency_hz": 2000.0}}
    held = play(make(values), n)["plant.displacement"]
    smooth = play(make({**values, "plant.drive": "analogue"}), n)["plant.displacement"]
    gain = -4 * 24 * 8.8541878128e-12 * (2.0 / 2.1) * 20.0 / K * 1e6

    phi, gamma = held_model(gain, dt)
    state, expected = np.zeros(2), np.empty(n)
    for i in range(n):
        expected[i] = state[0]
        state = phi @ state + gamma * volts * math.sin(2 * math.pi * 2.0 * i * dt)
    np.testing.assert_allclose(held, expected, atol=1e-10)

    a, b = continuous(gain)
    w = 2 * math.pi * 2.0
    steady = np.linalg.solve(1j * w * np.eye(2) - a, b[:, 0] * volts)
    over, free, exact = linalg.expm(a * dt), np.imag(steady), []
    for t in np.arange(n) * dt:
        exact.append((np.imag(steady * np.exp(1j * w * t)) - free)[0])
        free = over @ free
    peak = np.abs(exact).max()
    assert np.abs(smooth - exact).max() < 2e-5 * peak  # (w dt)^4 / 12 = 2e-5
    assert np.abs(smooth - exact).max() < 0.001 * np.abs(held - exact).max()
    assert np.abs(held - smooth).max() / peak == pytest.approx(0.066, abs=0.002)


@pytest.mark.parametrize("plant", ["linear", "nonlinear"])
def test_analogue_drive_is_exact_to_fourth_order(plant):
    def error(rate: float) -> float:
        values = {
            "sample_rate_khz": rate,
            "plant.model": plant,
            "plant.drive": "analogue",
            "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 2000.0},
        }
        if plant == "nonlinear":
            values |= {"plant.cubic_n_m3": 0.0, "plant.substeps": 16}
        x = play(make(values), int(4 * rate))["plant.displacement"]
        gain = -4 * 24 * 8.8541878128e-12 * (2.0 / 2.1) * 20.0 / K * 1e6
        a, b = continuous(gain)
        w = 4 * math.pi
        steady = np.linalg.solve(1j * w * np.eye(2) - a, b[:, 0] * 10.0)
        t = np.arange(len(x)) / rate
        one, state, free = linalg.expm(a / rate), np.imag(steady), []
        for _ in t:
            free.append(state[0])
            state = one @ state
        return float(np.abs(x - np.imag(steady[0] * np.exp(1j * w * t)) + free).max())

    order = math.log2(error(40.0) / error(80.0))
    assert 2.8 < order < 4.5


# -- nonlinear plant


def test_nonlinear_plant_without_nonlinearity_converges_to_the_linear_one():
    values = {"sample_rate_khz": 20.0, "reference": {"kind": "square", "amplitude_v": 10.0, "frequency_hz": 900.0}}
    exact = play(make(values), 200)["plant.displacement"]
    errors = []
    for substeps in (1, 2, 4, 8):
        found = play(
            make({**values, "plant.model": "nonlinear", "plant.cubic_n_m3": 0.0, "plant.substeps": substeps}), 200
        )["plant.displacement"]
        errors.append(np.abs(found - exact).max())
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders == pytest.approx(4.0, abs=0.35)


CONSERVATIVE = {**STILL, "plant.model": "nonlinear", "device.damping_ns_m": 1e-22, "plant.substeps": 16}


def test_energy_is_conserved_without_damping():
    cubic = 2e9
    trace = play(make({**CONSERVATIVE, "plant.cubic_n_m3": cubic, "plant.initial_displacement_um": 4.0}), 400)
    x, v = trace["plant.displacement"] * 1e-6, trace["plant.velocity"] * 1e-3
    energy = 0.5 * M * v**2 + 0.5 * K * x**2 + 0.25 * cubic * x**4
    assert 0.25 * cubic * x[0] ** 4 > 0.05 * energy[0]  # the cubic spring does take part
    assert np.abs(energy / energy[0] - 1).max() < 1e-6


@pytest.mark.parametrize("amplitude", [1.0, 4.0, 8.0])
def test_period_of_the_hardening_spring(amplitude):
    cubic = 1e9
    x = play(
        make(
            {
                **CONSERVATIVE,
                "sample_rate_khz": 1000,
                "plant.cubic_n_m3": cubic,
                "plant.initial_displacement_um": amplitude,
            }
        ),
        3000,
    )["plant.displacement"]
    rising = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))
    zeros = rising - x[rising] / (x[rising + 1] - x[rising])
    stiff = cubic * (amplitude * 1e-6) ** 2
    omega = math.sqrt((K + stiff) / M)
    expected = 4 * special.ellipk(stiff / (2 * (K + stiff))) / omega * 1e6
    assert np.diff(zeros) == pytest.approx(expected, rel=1e-5)


def test_dry_friction_takes_the_same_off_every_cycle():
    friction = 20e-9
    x = play(
        make(
            {
                **CONSERVATIVE,
                "plant.cubic_n_m3": 0.0,
                "plant.friction_nn": friction * 1e9,
                "plant.slip_velocity_um_ms": 1e-3,
                "plant.initial_displacement_um": 8.0,
                "sample_rate_khz": 1000,
            }
        ),
        1900,
    )["plant.displacement"]
    tops = [x[i] for i in range(1, len(x) - 1) if x[i - 1] < x[i] >= x[i + 1] and x[i] > 1.0]
    tops = [8.0, *tops]
    assert len(tops) > 3
    assert -np.diff(tops) == pytest.approx(4 * friction / K * 1e6, rel=1e-2)


def test_a_runaway_inside_one_tick_trips_the_board():
    values = {**STILL, "plant.model": "nonlinear", "plant.initial_displacement_um": 20.0}
    free = {"plant.stop_stiffness_n_m": 0.0, "plant.stop_damping_ns_m": 0.0}  # steps are short at a stop
    board = make({**values, **free, "plant.cubic_n_m3": 1e12, "guard.travel_um": 1000.0})
    trace = play(board, 50)
    assert board.trip is not None, trace["plant.displacement"][:4]
    assert "plant" in board.trip.reason or "travel" in board.trip.reason


# -- heat


@pytest.mark.parametrize(("plant", "damping"), [("linear", 4.0), ("nonlinear", 0.0)])
def test_thermal_motion_obeys_equipartition(plant, damping):
    values = {**STILL, "plant.thermal_noise": True, "plant.model": plant}
    if plant == "nonlinear":
        values["plant.cubic_n_m3"] = 0.0
    found, speed = [], []
    for seed in range(1, 13):
        board = make({**values, "seed": seed})
        if damping:
            inject(board, damping=damping)
        trace = play(board, 40_000)  # 0.4 s
        found.append(rms(trace["plant.displacement"][500:]))
        speed.append(rms(trace["plant.velocity"][500:]))
    expected = math.sqrt(1.380649e-23 * 300.0 / K) * 1e6
    assert expected == pytest.approx(0.2775e-3, rel=1e-3)
    assert np.mean(found) == pytest.approx(expected, rel=0.03)
    # held noise and a 10 us sample leave a little out of the velocity
    assert np.mean(speed) == pytest.approx(math.sqrt(1.380649e-23 * 300.0 / M) * 1e3, rel=0.06)


def test_thermal_motion_follows_the_temperature():
    def motion(kelvin: float) -> float:
        values = {**STILL, "plant.thermal_noise": True, "environment.temperature_k": kelvin}
        return rms(play(make(values), 60_000)["plant.displacement"])

    # equipartition, with silicon 63 ppm/K softer where it is warmer; 600 ms hold some 500 independent values
    softer = (1 - 63e-6 * 300) / (1 + 63e-6 * 150)
    assert motion(600.0) / motion(150.0) == pytest.approx(math.sqrt(4.0 / softer), rel=0.08)
    assert rms(play(make({**STILL, "plant.thermal_noise": False}), 1000)["plant.displacement"]) == 0.0


def test_faults_scale_the_true_device():
    board = make({**STILL, "plant.initial_displacement_um": 4.0, "sample_rate_khz": 1000})
    inject(board, added_mass=0.5, stiffness=0.2, damping=1.0)
    x = play(board, 1500)["plant.displacement"]
    t = np.arange(len(x)) * 1e-6
    sigma = 2 * BETA / (2 * 1.5 * M)
    omega = math.sqrt(1.2 * K / (1.5 * M) - sigma**2)
    exact = 4 * np.exp(-sigma * t) * (np.cos(omega * t) + sigma / omega * np.sin(omega * t))
    np.testing.assert_allclose(x, exact, atol=1e-10)
