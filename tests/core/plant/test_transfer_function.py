"""Plants given as transfer functions, and what suits them, against closed forms and another library."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy import signal

from core.device.catalogue import devices
from core.device.oscillator import held
from core.device.transfer_function import of_coefficients, slowest_pole
from core.errors import InputError
from tests.lab import inject, make, play

PLANTS = {device.id: device for device in devices() if device.transfer_function is not None}


def bench(name: str, values: dict[str, Any] | None = None):
    plain = {"device": {"id": name}, "plant": {}, "sample_rate_khz": 1, "guard.travel_um": 1000}
    return make(
        {**plain, "drive.limit_v": 1000, "reference": {"kind": "constant", "amplitude_v": 0.0}, **(values or {})}
    )


@pytest.mark.parametrize(
    ("coefficients", "h"),
    [
        ((1.0, 0.5, 2.0), 0.3),
        ((1.0, 5.0, 2.0), 0.3),
        ((2.0, -0.4, 1.0), 0.5),
        ((1.0, 0.3, -0.7), 0.4),
        ((1.0, 0.5, 0.0), 0.7),
        ((3.0, 0.0, 0.0), 0.2),
        ((0.0, 2.0, 1.0), 0.3),
        ((0.0, 1.0, -0.2), 0.3),
        ((0.0, 4.0, 0.0), 0.3),
    ],
)
def test_held_is_the_exact_sample_of_any_coefficients(coefficients, h):
    m, b, k = coefficients
    found = held(m, b, k, h)
    if m == 0.0:
        one = np.ones((1, 1))
        a, b1, *_ = signal.cont2discrete((-k / b * one, one / b, one, 0.0 * one), h)
        assert (found[0], found[4]) == pytest.approx((a[0, 0], b1[0, 0]), rel=1e-12)
        return
    a, b1, *_ = signal.cont2discrete(
        (np.array([[0, 1], [-k / m, -b / m]]), np.array([[0], [1 / m]]), np.eye(2), np.zeros((2, 1))), h
    )
    np.testing.assert_allclose(np.reshape(found[:4], (2, 2)), a, rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(found[4:], b1[:, 0], rtol=1e-11)


def test_the_plants_of_chapter_4_move_as_their_equations_say():
    start = {"plant": {"initial_displacement_um": 1.0}}
    t = np.arange(4000) * 1e-3
    unstable = play(bench("unstable-first-order", start), 4000)
    np.testing.assert_allclose(unstable["plant.displacement"], np.exp(0.2 * t), rtol=1e-11)
    np.testing.assert_allclose(unstable["plant.velocity"][1:], 0.2e-3 * np.exp(0.2 * t[1:]), rtol=1e-9)
    pushed = bench("double-integrator", {**start, "reference.amplitude_v": 0.5})
    x = play(pushed, 4000)["plant.displacement"]
    np.testing.assert_allclose(x, 1 + 0.25 * t**2, rtol=1e-9)
    gain = play(bench("first-order-gain", {"reference.amplitude_v": 2.0}), 4000)["plant.displacement"]
    np.testing.assert_allclose(gain, 2 * (1 - np.exp(-t)), rtol=1e-9, atol=1e-12)


def test_faults_multiply_the_coefficients():
    board = bench("second-order-gain", {"reference.amplitude_v": 1.0})
    inject(board, added_mass=0.5, stiffness=1.0, damping=3.0, drive_gain=-0.5)
    x = play(board, 3000)["plant.displacement"]
    _, expected = signal.step(([0.5], [1.5, 4.0, 2.0]), T=np.arange(3000) * 1e-3)
    np.testing.assert_allclose(x, expected, atol=1e-9)


@pytest.mark.parametrize("numerator", [[1.0], [1.0, 1.0], [-2.0, 0.5]])
@pytest.mark.parametrize("denominator", [[1.0, 5.0, 6.0], [1.0, 1.0]])
def test_a_reference_model_may_be_any_transfer_function(numerator, denominator):
    model = {"kind": "transfer_function", "numerator": numerator, "denominator": denominator}
    if len(numerator) == len(denominator):
        with pytest.raises(InputError, match="shorter"):
            bench("unstable-first-order", {"model": model})
        return
    reference = {"kind": "constant", "amplitude_v": 3.0}
    board = bench("double-integrator", {"model": model, "reference": reference})
    found = play(board, 3000)["model.displacement"]
    _, expected = signal.step((numerator, denominator), T=np.arange(len(found)) * 1e-3)
    np.testing.assert_allclose(found, 3 * expected, atol=1e-9)


def test_figures_are_those_that_mean_something():
    assert PLANTS["unstable-first-order"].metrics() == pytest.approx(
        {"slowest_pole_per_s": 0.2, "static_gain_um_per_v": -5.0}
    )
    assert PLANTS["double-integrator"].metrics() == {"slowest_pole_per_s": 0.0}
    found = PLANTS["second-order-gain"].metrics()
    assert found["f0_hz"] == pytest.approx(1 / (2 * math.pi)) and found["slowest_pole_per_s"] == pytest.approx(-0.5)


@pytest.mark.parametrize("fast", [0.7e6, 0.7e9, 0.7e12])
def test_the_slow_one_of_two_poles_far_apart_has_all_its_digits(fast):
    """The roots of s^2 + (slow + fast) s + slow fast are -slow and -fast."""
    slow = 0.3
    plant = of_coefficients(1.0, [1.0, slow + fast, slow * fast], 1.0)
    assert slowest_pole(plant) == pytest.approx(-slow, rel=1e-14)


@pytest.mark.parametrize("name", sorted(PLANTS))
def test_every_one_runs_with_all_that_suits_it(name):
    board = bench(name)
    assert board.spec.document["plant"]["model"] == "transfer_function"
    assert ("mrac" in board.spec.controllers) == ("single_beam" in board.spec.sensors) == (name == "second-order-gain")
    trace = play(board, 600)
    assert board.trip is None and all(np.all(np.isfinite(values)) for values in trace.values())


def test_what_does_not_suit_is_refused_by_name():
    for values, field in (
        ({"device": {"id": "unstable-first-order"}, "controller": {"kind": "pid"}}, "controller.kind"),
        ({"device": {"id": "double-integrator"}, "plant": {"model": "linear"}}, "plant.model"),
        ({"device": {"id": "ch3"}, "plant": {"model": "transfer_function"}}, "plant.model"),
        ({"device": {"id": "ch3"}, "plant": {}, "controller": {"kind": "gain_adaptation"}}, "controller.kind"),
        (
            {"device": {"id": "double-integrator"}, "plant": {}, "diagnosers": {"a": {"kind": "mmae"}}},
            "diagnosers.a.kind",
        ),
        ({"device": {"id": "double-integrator"}, "plant": {}, "sensor": {"kind": "single_beam"}}, "sensor.kind"),
        ({"device": {"id": "double-integrator"}, "plant": {}, "model": {"kind": "damped"}}, "model.kind"),
        (
            {"device": {"id": "double-integrator", "transfer_function": {"denominator": [0, 1]}}},
            "device.transfer_function",
        ),
    ):
        with pytest.raises(InputError) as error:
            make({"plant": {}, **values})
        assert error.value.field == field
