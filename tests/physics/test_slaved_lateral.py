"""The plant that is calibrated to the text: its fold, its poles and its contact."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import integrate, optimize

from core.plant import slaved_lateral
from core.plant.equilibrium import fold, slaved_force, stators_of, voltage_at
from scenarios.measure.lateral import lateral_metrics
from tests.lab import make, play

EPS, N, T, G = 8.8541878128e-12, 87, 2.0, 2.1
STILL = {"reference": {"kind": "constant", "amplitude_v": 0.0}}


def slaved(**values):
    return make(
        {
            "device": {"id": "lcr-350", "bias_v": 5.0},
            "plant": {"model": "slaved_lateral", "thermal_noise": False, **values.pop("plant", {})},
            **STILL,
            **values,
        }
    )


def packed(board):
    return board.wiring.parameters("plant")


def textbook_slaved(x, v, k1=0.0784, kappa=0.42, overlap=5.0, bias=5.0, g=G):
    """The equation as written, uN."""
    a = N * EPS * T * 1e6
    eta = kappa * x
    whole, slope = 2 * g / (g * g - eta * eta), 4 * g * eta / (g * g - eta * eta) ** 2
    one = (bias - v) ** 2 * (whole + kappa * slope * (overlap + x))
    other = (-bias - v) ** 2 * (-whole + kappa * slope * (overlap - x))
    return -k1 * x + 0.5 * a * (one + other)


def test_slaved_plant_folds_where_the_text_says():
    p = packed(slaved())
    force = slaved_force(p, 0.0784)
    for x, v in ((1.0, -3.0), (2.5, 2.0), (-1.7, 4.0)):
        found = float(force(np.array([x]), (5 - v) ** 2, (-5 - v) ** 2)[0])
        assert found == pytest.approx(textbook_slaved(x, v), rel=1e-9)
    end = fold(force, stators_of(p), lambda q: 0.42 * float(q[0]), 1)
    assert end is not None
    assert abs(end.x_um) == pytest.approx(1.660, rel=5e-3)
    assert abs(end.volts) == pytest.approx(3.914, rel=5e-3)
    assert abs(end.lateral_um) == pytest.approx(G / 3, rel=0.01)
    # the same with the textbook equation and a bracketing solver
    drive = lambda x: optimize.brentq(lambda v: textbook_slaved(x, v), -4.9, 0.0)  # noqa: E731
    best = optimize.minimize_scalar(drive, bounds=(1.0, 2.2), method="bounded", options={"xatol": 1e-8})
    assert abs(end.x_um) == pytest.approx(best.x, rel=1e-3)
    assert abs(end.volts) == pytest.approx(-best.fun, rel=1e-5)
    metrics = lateral_metrics(slaved_after_a_tick())
    assert metrics["lateral.fold_um"] == pytest.approx(1.660, rel=5e-3)


@pytest.mark.parametrize("gap", [1.5, 3.0])
def test_the_force_is_that_of_the_gap_given(gap):
    force = slaved_force(packed(slaved(plant={"gap_um": gap})), 0.0784)
    for x, v in ((1.0, -3.0), (2.5, 2.0), (-1.7, 4.0)):
        found = float(force(np.array([x]), (5 - v) ** 2, (-5 - v) ** 2)[0])
        assert found == pytest.approx(textbook_slaved(x, v, g=gap), rel=1e-9)


def slaved_after_a_tick():
    board = slaved()
    board.advance(1)
    return board


@pytest.mark.parametrize(("x", "volts", "pole"), [(2.0, 3.787, 9497), (2.1, 3.705, 11215), (3.0, 2.196, 25324)])
def test_unstable_poles_beyond_the_fold(x, volts, pole):
    p = packed(slaved())
    found = voltage_at(slaved_force(p, 0.0784), x, np.array([x, -3.0]), (5.0, -5.0))
    assert found is not None and found[1] == pytest.approx(-volts, rel=5e-3)
    # the plant itself, held there and released 1 nm off: the growth of the deviation
    board = slaved(
        plant={"initial_displacement_um": x + 1e-3},
        reference={"kind": "constant", "amplitude_v": found[1]},
        sample_rate_khz=500,
    )
    shift = play(board, 400)["plant.displacement"] - x
    late = (shift > 0.02) & (shift < 0.04)
    rate = np.polyfit(np.flatnonzero(late) * 2e-6, np.log(shift[late]), 1)[0]
    assert rate == pytest.approx(pole, rel=0.03)


def test_hard_fingers_are_followed_whatever_step_is_asked_for():
    """Insulated fingers that bounce off the stator under a held voltage, against an adaptive solver."""
    plant = {"contact_stiffness_n_m": 1e4, "step_us": 0.5, "ratio": 1.0, "short_on_contact": False}
    volts = {"kind": "constant", "amplitude_v": -4.5}
    rest = {"sample_rate_khz": 200, "guard.stop_on_contact": False, "device.bias_v": 3.0}
    found = play(slaved(plant=plant, reference=volts, **rest), 120)["plant.displacement"]

    def motion(_, state):
        x, v = state
        inside = min(max(x, -0.9 * G), 0.9 * G)
        whole, slope = 2 * G / (G * G - inside**2), 4 * G * inside / (G * G - inside**2) ** 2
        whole += slope * (x - inside)
        pull = 7.5**2 * (whole + slope * max(5 + x, 0.0)) + 1.5**2 * (-whole + slope * max(5 - x, 0.0))
        total = 0.5 * N * EPS * T * 1e6 * pull - 0.0784 * x - 7.09e-4 * v
        over = abs(x) - (G - 0.15)
        total -= (math.copysign(1e4 * over, x) + 1.5e-2 * v) if over > 0.0 else 0.0
        return [v, total / 2.2090e-4]

    t = np.arange(120) * 5e-3
    exact = integrate.solve_ivp(motion, (0, t[-1]), [0.0, 0.0], "DOP853", t, rtol=1e-9, atol=1e-12, max_step=1e-4).y[0]
    assert np.abs(exact).max() > G - 0.15
    before = int(np.argmax(exact > 1.5))
    np.testing.assert_allclose(found[:before], exact[:before], atol=1e-3)
    assert np.abs(found).max() < np.abs(exact).max() + 0.02


def test_acceptance_of_the_slaved_plant_s_contact():
    board = slaved(reference={"kind": "constant", "amplitude_v": -4.5}, sample_rate_khz=200)
    trace = play(board, 2000)
    assert board.trip is not None and board.trip.signal == "plant.lateral"
    assert abs(trace["plant.lateral"][-1]) > G - 0.16
    assert slaved_lateral.SlavedLateral.title.endswith("(calibration)")
