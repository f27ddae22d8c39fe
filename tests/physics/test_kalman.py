"""One Kalman filter of a bank against scipy and filterpy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from filterpy.kalman import KalmanFilter
from scipy.linalg import solve_discrete_are

from core.diagnose.kalman import steady_gain
from tests.lab import make, play
from tests.physics.bank import FACTORS, NAMES, K, M, model, of_bank, signals


def test_steady_gain_has_the_figures_of_the_riccati_equation():
    phi, gamma = model(FACTORS["healthy"])
    q, r = 0.3**2, 0.05**2
    k1, k2, psi, left = steady_gain(phi, gamma @ gamma.T * q, r, False)
    assert k1 == pytest.approx(0.1434, rel=0.01)
    assert k2 == pytest.approx(0.5540, rel=0.01)
    assert psi / r == pytest.approx(1.167, rel=0.01)
    prior = solve_discrete_are(phi.T, np.array([[1.0], [0.0]]), gamma @ gamma.T * q, np.array([[r]]))
    assert psi == pytest.approx(prior[0, 0] + r, rel=1e-9)
    np.testing.assert_allclose([k1, k2], prior[:, 0] / (prior[0, 0] + r), rtol=1e-9)
    # the recursion itself, to its limit
    p = np.eye(2)
    for _ in range(2000):
        p = phi @ p @ phi.T + gamma @ gamma.T * q
        gain = p[:, :1] / (p[0, 0] + r)
        last, p = p, p - gain @ p[:1]
    np.testing.assert_allclose([k1, k2], gain[:, 0], rtol=1e-9)
    assert psi == pytest.approx(last[0, 0] + r, rel=1e-9)
    np.testing.assert_allclose([[k1 * r, k2 * r], [k2 * r, left]], p, rtol=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_filter_step_by_step_against_filterpy(name):
    trace = signals(600, faults={"added_mass": 0.05})
    phi, gamma = model(FACTORS[name])
    kalman = KalmanFilter(dim_x=2, dim_z=1, dim_u=1)
    kalman.F, kalman.B, kalman.H = phi, gamma, np.array([[1.0, 0.0]])
    kalman.Q, kalman.R = gamma @ gamma.T * 0.09, np.array([[0.0025]])
    kalman.x = np.zeros((2, 1))
    kalman.P = np.diag([1.0, K / M * 1e-6])
    found, covariance = trace[f"kalman.residual.{name}"], trace[f"kalman.nis.{name}"]
    for i, z in enumerate(trace["sensor.displacement"]):
        if i:
            kalman.predict(u=np.array([[trace["drive.voltage"][i - 1]]]))
        kalman.update(z)
        assert found[i] == pytest.approx(kalman.y[0, 0], abs=1e-12)
        assert covariance[i] == pytest.approx(kalman.y[0, 0] ** 2 / kalman.S[0, 0], rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("form", ["recursive", "steady"])
@pytest.mark.parametrize(("every", "sensor_every"), [(2, 1), (5, 1), (1, 2), (2, 3)])
def test_between_two_measurements_a_filter_predicts_tick_by_tick(every, sensor_every, form):
    """The same as a filter at every tick that gets measurements only at its turns."""
    turn = math.lcm(every, sensor_every)
    bank = {"kind": "mmae", "process_noise_v": 0.3, "every": every, "form": form}
    values = {"sensor": {"kind": "ideal", "noise_um": 0.05, "every": sensor_every}, "diagnosers": {"kalman": bank}}
    trace = signals(1500, values, {"stiffness": 0.05})
    for name in NAMES:
        phi, gamma = model(FACTORS[name])
        x, p = np.zeros(2), np.diag([1.0, K / M * 1e-6])
        expected = []
        for i, z in enumerate(trace["sensor.displacement"]):
            if i:
                x = phi @ x + gamma[:, 0] * trace["drive.voltage"][i - 1]
                p = phi @ p @ phi.T + gamma @ gamma.T * 0.09
            if i % turn == 0:
                residual, psi = z - x[0], p[0, 0] + 0.0025
                expected.append((residual, residual**2 / psi))
                x, p = x + p[:, 0] / psi * residual, p - np.outer(p[:, 0], p[0]) / psi
        found = np.column_stack([trace[f"kalman.{what}.{name}"][::turn] for what in ("residual", "nis")])
        settled = 0 if form == "recursive" else 1000 // turn
        np.testing.assert_allclose(found[settled:], expected[settled:], rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("every", [1, 2, 5])
@pytest.mark.parametrize(("device", "rate_khz"), [("ch3", 50), ("fabricated-1", 120)])
def test_noise_of_the_voltage_as_assumed_is_as_large_as_expected(device, rate_khz, every):
    """Squared residuals over their covariance are 1 on average, however often the bank corrects."""
    document = {
        "sample_rate_khz": rate_khz,
        "device": {"id": device},
        "plant": {"model": "linear", "drive_noise_v": 0.5, "thermal_noise": False},
        "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 800.0},
        "sensor": {"kind": "ideal", "noise_um": 0.01},
        "diagnosers": {"kalman": {"kind": "mmae", "process_noise_v": 0.5, "every": every}},
    }
    nis = play(make(document), 20_000)["kalman.nis.healthy"][1000::every]
    assert nis.mean() == pytest.approx(1.0, abs=5.0 * math.sqrt(2.0 / len(nis)))


@pytest.mark.parametrize(("form", "every"), [("recursive", 1), ("recursive", 3), ("steady", 1)])
def test_the_gains_are_those_of_the_riccati_recursion(form, every):
    r"""By the formula: the covariance is predicted at every tick, :math:`K=P^-H^T/\psi` where the bank corrects."""
    trace = signals(120, {"diagnosers": {"kalman": {"kind": "mmae", "form": form, "every": every}}})
    for name in NAMES:
        phi, gamma = model(FACTORS[name])
        noise = gamma @ gamma.T * 0.3**2
        p, expected = np.diag([1.0, K / M * 1e-6]), []
        for i in range(120 if form == "recursive" else 4000):
            p = phi @ p @ phi.T + noise if i else p
            if i % every == 0:
                gain = p[:, 0] / (p[0, 0] + 0.05**2)
                p = p - np.outer(gain, p[0])
            expected.append(gain)  # held between two corrections
        expected = expected if form == "recursive" else [expected[-1]] * 120
        found = [trace[f"kalman.gain_{state}.{name}"] for state in ("displacement", "velocity")]
        np.testing.assert_allclose(np.column_stack(found), expected, rtol=1e-8)


@pytest.mark.parametrize("kind", ["imm", "reseed", "lock_in", "consistency", "cusum", "lock_in_glr", "two_output"])
def test_every_bank_of_filters_shows_its_gains(kind):
    r"""Since :math:`\psi=HP^-H^T+R`, the gain of the displacement is :math:`1-R/\psi`."""
    values = {"diagnosers": {"kalman": {"kind": kind}}}
    trace = signals(300, values | ({"sensor": {"kind": "ideal", "noise_um": 0.05}} if kind == "two_output" else {}))
    residual = of_bank(trace, "residual")[1:]
    square = of_bank(trace, "nis")[1:]
    gain = of_bank(trace, "gain_displacement")[1:]
    assert np.all(gain > 0.0) and np.all(np.isfinite(of_bank(trace, "gain_velocity")))
    if kind != "two_output":  # its square belongs to both residuals
        np.testing.assert_allclose(1.0 - 0.05**2 * square / residual**2, gain, rtol=1e-6, atol=1e-7)


def test_steady_form_is_the_filter_with_the_limit_gain():
    values = {"diagnosers": {"kalman": {"kind": "mmae", "process_noise_v": 0.3, "form": "steady"}}}
    trace = signals(600, values, {"damping": 0.3})
    for name in NAMES:
        phi, gamma = model(FACTORS[name])
        prior = solve_discrete_are(phi.T, np.array([[1.0], [0.0]]), gamma @ gamma.T * 0.09, np.array([[0.0025]]))
        psi = prior[0, 0] + 0.0025
        x = np.zeros(2)
        for i, z in enumerate(trace["sensor.displacement"]):
            if i:
                x = phi @ x + gamma[:, 0] * trace["drive.voltage"][i - 1]
            residual = z - x[0]
            assert trace[f"kalman.residual.{name}"][i] == pytest.approx(residual, abs=1e-9)
            assert trace[f"kalman.nis.{name}"][i] == pytest.approx(residual**2 / psi, rel=1e-6, abs=1e-9)
            x = x + prior[:, 0] / psi * residual


def test_recursive_and_steady_forms_agree_after_200_samples():
    both = {
        form: signals(2000, {"diagnosers": {"kalman": {"kind": "mmae", "process_noise_v": 0.3, "form": form}}})
        for form in ("recursive", "steady")
    }
    residuals = [of_bank(trace, "residual")[200:] for trace in both.values()]
    np.testing.assert_allclose(*residuals, atol=1e-9)
    weights = [of_bank(trace, "probability")[200:] for trace in both.values()]
    np.testing.assert_allclose(*weights, atol=1e-6)
    early = [of_bank(trace, "residual")[:40] for trace in both.values()]
    assert np.abs(early[0] - early[1]).max() > 1e-3


def test_matched_filter_is_consistent():
    """With the noise there is, residuals are white and as large as the filter says."""
    nis, lag = [], []
    for seed in range(1, 9):
        values = {"seed": seed, "diagnosers": {"kalman": {"kind": "mmae", "process_noise_v": 0.010}}}
        trace = signals(20_000, values)
        nis.append(trace["kalman.nis.healthy"][500:].mean())
        residual = trace["kalman.residual.healthy"][500:]
        lag.append(residual[1:] @ residual[:-1] / (residual @ residual))
    assert 0.98 < np.mean(nis) < 1.02
    assert abs(np.mean(lag)) < 0.02
    over = signals(20_000, {"diagnosers": {"kalman": {"kind": "mmae", "process_noise_v": 1.0}}})
    assert over["kalman.nis.healthy"][500:].mean() < 0.9


def test_assumed_noise_scales_variances():
    plain = signals(500)
    scaled = signals(
        500, {"diagnosers": {"kalman": {"kind": "mmae", "process_noise_v": 0.3, "assumed_noise_scale": 4.0}}}
    )
    late = slice(300, None)
    np.testing.assert_allclose(of_bank(plain, "residual")[late], of_bank(scaled, "residual")[late], atol=1e-8)
    np.testing.assert_allclose(of_bank(plain, "nis")[late], 4 * of_bank(scaled, "nis")[late], rtol=1e-6, atol=1e-12)


@pytest.mark.parametrize("form", ["recursive", "steady"])
def test_a_hypothesis_far_beyond_critical_damping_stays_a_number(form):
    thick = [{"name": "healthy"}, {"name": "thick", "mass": 0.01, "damping": 100.0}]
    bank = {"kind": "mmae", "form": form, "hypotheses": thick}
    trace = signals(2000, {"sample_rate_khz": 10, "diagnosers": {"kalman": bank}})
    assert all(np.all(np.isfinite(trace[f"kalman.{port}.thick"])) for port in ("probability", "residual", "nis"))
    assert np.all(trace["kalman.winner"][100:] == 0.0)
