"""End stops and steep friction, which may be faster than a sample: against an adaptive solver."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import integrate

from tests.lab import make, play

M, BETA, K = 2.2090e-10, 7.09e-7, 0.0538
LCR = {"device": {"id": "lcr-350"}}


@pytest.mark.parametrize("side", [1, -1])
def test_a_stop_holds_the_shuttle(side):
    x = play(
        make(
            {
                **LCR,
                "plant.model": "nonlinear",
                "plant.cubic_n_m3": 0.0,
                "plant.stop_um": 2.0,
                "reference": {"kind": "constant", "amplitude_v": -side * 10.0},
            }
        ),
        4000,
    )["plant.displacement"]
    pull = 0.5455e-6 * 10 * K  # N
    rest = 2.0 + (pull - K * 2e-6) / (K + 50.0) * 1e6
    assert side * x[-1] == pytest.approx(rest, rel=1e-5)
    assert side * x.max() < 2.2 or side * x.min() < 2.2
    free = play(make({**LCR, "reference": {"kind": "constant", "amplitude_v": -side * 10.0}}), 4000)
    assert side * free["plant.displacement"][-1] == pytest.approx(5.455, rel=2e-3)


def test_stops_and_spring_against_an_ode_solver():
    values = {
        "sample_rate_khz": 1000,
        "plant.model": "nonlinear",
        "plant.cubic_n_m3": 1e9,
        "plant.stop_um": 2.5,
        "plant.substeps": 16,
        "plant.stop_stiffness_n_m": 0.5,
        "plant.friction_nn": 5.0,
        "plant.slip_velocity_um_ms": 1.0,
        "plant.initial_velocity_um_ms": 60.0,
        "reference": {"kind": "constant", "amplitude_v": 2.0},
    }
    trace = play(make(values), 700)
    force = -4 * 24 * 8.8541878128e-12 * (2.0 / 2.1) * 20.0 * 2.0

    def motion(_: float, state: np.ndarray) -> list[float]:
        x, v = state
        over = max(abs(x) - 2.5e-6, 0.0)
        total = force - BETA * v - K * x - 1e9 * x**3 - 5e-9 * math.tanh(v / 1e-3)
        total -= math.copysign(0.5 * over, x) + (2e-5 * v if over else 0.0)
        return [v, total / M]

    t = np.arange(700) * 1e-6
    exact = integrate.solve_ivp(motion, (0, t[-1]), [0.0, 0.06], "DOP853", t, rtol=1e-10, atol=1e-15, max_step=1e-6).y
    assert np.abs(exact[0]).max() > 2.5e-6
    assert np.abs(trace["plant.displacement"] * 1e-6 - exact[0]).max() < 2e-4 * np.abs(exact[0]).max()


def bounced(n, rate_khz, stop, stop_stiffness, stop_damping, friction=0.0, slip=1.0, cubic=0.0, v0=0.06, volts=2.0):
    """Displacement under a held voltage by an adaptive solver whose steps are far shorter than any of these rates."""
    force = -4 * 24 * 8.8541878128e-12 * (2.0 / 2.1) * 20.0 * volts

    def motion(_: float, state: np.ndarray) -> list[float]:
        x, v = state
        over = max(abs(x) - stop, 0.0)
        total = force - BETA * v - K * x - cubic * x**3 - friction * math.tanh(v / slip)
        total -= math.copysign(stop_stiffness * over, x) + (stop_damping * v if over else 0.0)
        return [v, total / M]

    t = np.arange(n) / rate_khz * 1e-3
    found = integrate.solve_ivp(motion, (0, t[-1]), [0.0, v0], "DOP853", t, rtol=1e-9, atol=1e-15, max_step=2e-7).y
    return 1e6 * found[0]


@pytest.mark.parametrize("plant", ["nonlinear", "planar", "slaved_lateral"])
@pytest.mark.parametrize(("rate", "stiffness", "damping"), [(20, 50, 2e-5), (50, 50, 1e-4), (100, 5e3, 2e-5)])
def test_stops_are_followed_at_any_rate(plant, rate, stiffness, damping):
    """Also where the substeps asked for are longer than the stop takes to turn the shuttle back."""
    values = {
        "sample_rate_khz": rate,
        "plant.model": plant,
        "plant.stop_um": 3.0,
        "plant.stop_stiffness_n_m": stiffness,
        "plant.stop_damping_ns_m": damping,
        "plant.initial_velocity_um_ms": 60.0,
        "reference": {"kind": "constant", "amplitude_v": 2.0},
    }
    own = {
        "nonlinear": {"plant.cubic_n_m3": 0.0},
        "planar": {"plant.step_us": 1.0},
        "slaved_lateral": {"plant.step_us": 0.5, "plant.ratio": 0.0, "plant.stiffness_n_m": K},
    }
    found = play(make({**values, **own[plant]}), int(0.6 * rate))["plant.displacement"]
    exact = bounced(int(0.6 * rate), rate, 3e-6, stiffness, damping)
    assert np.sum(np.diff(np.sign(np.diff(exact))) != 0) > 1
    assert len(found) == len(exact)
    assert np.abs(found - exact).max() < 0.03


@pytest.mark.parametrize(("rate", "friction"), [(20, 20.0), (20, 200.0), (100, 200.0)])
def test_friction_that_is_steep_brings_the_shuttle_to_rest(rate, friction):
    """At the slip velocity of the defaults, over which 200 nN act in a quarter of a microsecond."""
    values = {
        "sample_rate_khz": rate,
        "plant.model": "nonlinear",
        "plant.cubic_n_m3": 0.0,
        "plant.friction_nn": friction,
        "plant.initial_velocity_um_ms": 60.0,
        "reference": {"kind": "constant", "amplitude_v": 2.0},
    }
    found = play(make(values), int(0.6 * rate))["plant.displacement"]
    exact = bounced(int(0.6 * rate), rate, 20e-6, 50.0, 2e-5, friction * 1e-9, 5e-5)
    assert np.abs(found - exact).max() < 1e-3


def test_hard_stops_change_nothing_where_they_are_not_met():
    drive = {"plant.model": "nonlinear", "reference": {"kind": "square", "amplitude_v": 8.0, "frequency_hz": 2300.0}}
    free = play(make({**drive, "plant.stop_stiffness_n_m": 0.0, "plant.stop_damping_ns_m": 0.0}), 2000)
    hard = play(make({**drive, "plant.stop_stiffness_n_m": 5e3, "plant.stop_damping_ns_m": 1e-3}), 2000)
    assert np.abs(free["plant.displacement"]).max() > 3.0
    assert np.array_equal(free["plant.displacement"], hard["plant.displacement"])


def test_resonance_at_a_low_rate_rings_between_the_stops():
    """The speed at a stop bounds how far the shuttle goes into it."""
    drive = {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 2400.0}
    values = {"sample_rate_khz": 20.0, "device.id": "lcr-350", "plant.model": "nonlinear", "reference": drive}
    board = make(values)
    trace = play(board, 2000)
    assert board.trip is None
    deepest = np.abs(trace["plant.velocity"]).max() * 1e-3 * math.sqrt(M / 50.0) * 1e6
    travel = np.abs(trace["plant.displacement"]).max()
    assert 20.0 < travel < 20.0 + deepest
