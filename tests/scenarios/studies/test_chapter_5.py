"""Outputs laid over each other, Kalman gains and estimated coefficients, against closed forms and plain recursions."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from scipy.linalg import expm

from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run

MASS, DAMPING, STIFFNESS, FORCE = 2.2090e-10, 7.09e-7, 0.0538, 6.375e-9
CHANGES = {
    "ch5-outputs-mass": [(1.05, 1.0, 1.0), (1.10, 1.0, 1.0)],
    "ch5-outputs-spring": [(1.0, 1.05, 1.0), (1.0, 1.10, 1.0), (1.05, 1.0, 1.0)],
    "ch5-outputs-damping": [(1.0, 1.0, 1.3)],
}


def response(mass: float, stiffness: float, damping: float) -> complex:
    """Return y/F at 2 kHz, 1/(k - m w^2 + j b w)."""
    w = 2 * math.pi * 2000.0
    return 1.0 / (STIFFNESS * stiffness - MASS * mass * w**2 + 1j * DAMPING * damping * w)


@pytest.mark.parametrize("name", CHANGES)
def test_outputs_change_as_the_response_of_the_device_does(name):
    found = run(get(name)).metrics
    for stretch, change in enumerate(CHANGES[name], 2):
        ratio = response(*change) / response(1.0, 1.0, 1.0)
        # held for a sample, the drive is as much smaller and later for every device but for its distortion
        assert found[f"outputs.amplitude_change_pct.{stretch}"] == pytest.approx(100 * (abs(ratio) - 1), abs=0.1)
        assert found[f"outputs.phase_shift_deg.{stretch}"] == pytest.approx(math.degrees(cmath.phase(ratio)), abs=0.05)


def test_outputs_are_shown_over_each_other_at_the_same_phase_of_the_drive():
    result = run(get("ch5-outputs-damping"))
    study, params = result.scenario.study
    (healthy, at, before), (damped, later, after) = study.picture(result.board, params).curves
    assert (healthy, damped) == ("healthy", "damping 30\u00a0%")
    assert at == pytest.approx(later) and len(at) == 50
    assert max(after) / max(before) == pytest.approx(1 - 0.0573, abs=0.01)


@pytest.mark.parametrize(
    ("values", "field"),
    [
        ({"events": []}, "events"),
        ({"study.periods": 100}, "study.periods"),
        ({"reference": {"kind": "step", "amplitude_v": 1.0}}, "reference.kind"),
    ],
)
def test_outputs_say_what_they_need(values, field):
    with pytest.raises(InputError) as refused:
        run(with_values(get("ch5-outputs-mass"), values))
    assert refused.value.field == field


def recursion(mass: float, stiffness: float, damping: float, r: np.ndarray) -> np.ndarray:
    """Return the gain that the recursion of 5.2.3.1.5-6 ends at, in um and ms, with H = I for two variances."""
    a = np.array([[0.0, 1.0], [-STIFFNESS * stiffness / (MASS * mass) / 1e6, -DAMPING * damping / (MASS * mass) / 1e3]])
    push = np.array([[0.0], [FORCE / (MASS * mass)]])  # um/ms^2 for a volt
    whole = expm(np.block([[a, push], [np.zeros((1, 3))]]) * 0.02)
    phi, gamma = whole[:2, :2], whole[:2, 2:]
    h = np.eye(2)[: len(r)]
    p = np.eye(2)
    for _ in range(4000):
        psi = h @ p @ h.T + np.diag(r)
        p = gamma @ gamma.T * 1e-4 + phi @ p @ phi.T - phi @ p @ h.T @ np.linalg.inv(psi) @ h @ p @ phi.T
    gain: np.ndarray = p @ h.T @ np.linalg.inv(h @ p @ h.T + np.diag(r))
    return gain


def test_gains_are_those_the_recursion_ends_at():
    found = run(get("ch5-kalman-gains-50-khz")).metrics
    for name, factors in (("healthy", (1.0, 1.0, 1.0)), ("k+10", (1.0, 1.1, 1.0)), ("b+30", (1.0, 1.0, 1.3))):
        one = recursion(*factors, np.array([1e-4]))
        assert found[f"gains.one.displacement.{name}"] == pytest.approx(one[0, 0], rel=1e-6)
        assert found[f"gains.one.velocity_per_ms.{name}"] == pytest.approx(one[1, 0], rel=1e-6)
        both = recursion(*factors, np.array([1e-4, 1e-4]))
        names = [["displacement", "displacement_by_velocity_ms"], ["velocity_per_ms", "velocity_by_velocity"]]
        for row in range(2):
            for column in range(2):
                gain = found[f"gains.both.{names[row][column]}.{name}"]
                assert gain == pytest.approx(both[row, column], rel=1e-6)


def test_gains_that_do_not_rest_are_off_the_equation():
    early = run(with_values(get("ch5-kalman-gains-50-khz"), {"study.samples": 20})).metrics
    assert early["gains.one.riccati_error_pct"] > 1.0


def test_gains_want_a_bank_of_filters():
    with pytest.raises(InputError, match="needs a bank of Kalman filters"):
        run(with_values(get("ch5-kalman-gains-50-khz"), {"diagnosers": {"regions": {"kind": "regions"}}}))


def test_estimates_are_of_the_device_where_nothing_is_noisy():
    quiet = {
        "sensor.noise_um": 0.0,
        "plant.drive_noise_v": 1.0,
        "identifiers.longer.forgetting": 1.0,
        "sample_rate_khz": 20,
    }
    found = run(with_values(get("ch5-estimates-device-2"), quiet)).metrics
    damping, stiffness = 1.2975e-06, 0.12374
    decay, turn = damping / (2 * MASS), math.sqrt(stiffness / MASS - (damping / (2 * MASS)) ** 2)
    a2, a1 = math.exp(-2 * decay / 20e3), -2 * math.exp(-decay / 20e3) * math.cos(turn / 20e3)
    assert found["estimates.longer.a2_true"] == pytest.approx(a2, rel=1e-4)
    assert found["estimates.longer.a1_true"] == pytest.approx(a1, rel=1e-4)
    assert found["estimates.printed.a2_true"] == found["estimates.longer.a2_true"]
    assert found["estimates.longer.a2_spread"] < 0.02 < found["estimates.printed.a2_spread"]


def test_estimates_want_an_identifier_of_the_sampled_plant():
    with pytest.raises(InputError, match="needs an identifier of the sampled plant"):
        run(with_values(get("ch5-estimates-device-1"), {"identifiers": {"one": {"kind": "gradient"}}}))
