"""Weighted estimates against closed forms, filterpy and filters written here."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from filterpy.kalman import IMMEstimator, KalmanFilter

from scenarios.campaign.batch import outcomes
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.lab import rms
from tests.physics.bank import FACTORS, NAMES, K, M, model, of_bank, signals

TWO = {"healthy": FACTORS["healthy"], "k+10": FACTORS["k+10"]}
STATES = ("state_displacement", "state_velocity")


def bank_of(factors: dict[str, Any], **values: Any) -> dict[str, Any]:
    """Return a bench whose bank has these hypotheses, and weighs every sample."""
    hypotheses = [{"name": name, "mass": m, "stiffness": k, "damping": b} for name, (m, k, b) in factors.items()]
    bank = {"kind": "mmae", "process_noise_v": 0.3, "least_drive_v": 0.0, "hypotheses": hypotheses, **values}
    return {"diagnosers": {"kalman": bank}}


def reference(z: np.ndarray, u: np.ndarray, factors: dict[str, Any], q: float = 0.3) -> tuple[np.ndarray, np.ndarray]:
    """Return states (samples, models, 2) and covariances (samples, models, 2, 2) of filters apart."""
    models = [model(own) for own in factors.values()]
    x, p = np.zeros((len(models), 2)), np.tile(np.diag([1.0, K / M * 1e-6]), (len(models), 1, 1))
    states, covariances = [], []
    for i, value in enumerate(z):
        for k, (phi, gamma) in enumerate(models):
            if i:
                x[k] = phi @ x[k] + gamma[:, 0] * u[i - 1]
                p[k] = phi @ p[k] @ phi.T + gamma @ gamma.T * q * q
            gain = p[k, :, 0] / (p[k, 0, 0] + 0.05**2)
            x[k] = x[k] + gain * (value - x[k, 0])
            p[k] = p[k] - np.outer(gain, p[k, 0])
        states.append(x.copy())
        covariances.append(p.copy())
    return np.array(states), np.array(covariances)


def mixed(weights: np.ndarray, states: np.ndarray, covariances: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return mean and covariance of mixtures."""
    mean = np.einsum("sk,ski->si", weights, states)
    off = states - mean[:, None]
    return mean, np.einsum("sk,skij->sij", weights, covariances + off[..., :, None] * off[..., None, :])


def found(trace: dict[str, np.ndarray], name: str = "kalman") -> tuple[np.ndarray, np.ndarray]:
    """Return the weighted state of every sample, and its covariance."""
    state, std = (
        np.column_stack([trace[f"{name}.weighted.{part}{end}"] for part in ("displacement", "velocity")])
        for end in ("", "_std")
    )
    covariance = std[:, :, None] * std[:, None, :]
    covariance[:, 0, 1] = covariance[:, 1, 0] = trace[f"{name}.weighted.covariance"]
    return state, covariance


def test_of_two_models_the_estimate_is_between_them_and_their_distance_is_doubt():
    r"""With two models, :math:`P=p_1P_1+p_2P_2+p_1p_2(x_1-x_2)(x_1-x_2)^T`."""
    trace = signals(400, bank_of(TWO), {"stiffness": 0.05})
    first, second = (of_bank(trace, "probability", [name])[:, 0] for name in TWO)
    _, p = reference(trace["sensor.displacement"], trace["drive.voltage"], TWO)
    x1, x2 = (np.column_stack([trace[f"kalman.{state}.{name}"] for state in STATES]) for name in TWO)
    state, covariance = found(trace)
    np.testing.assert_allclose(state, first[:, None] * x1 + second[:, None] * x2, atol=1e-12)
    apart = (x1 - x2)[:, :, None] * (x1 - x2)[:, None, :]
    shares = first[:, None, None], second[:, None, None]
    np.testing.assert_allclose(
        covariance, shares[0] * p[:, 0] + shares[1] * p[:, 1] + shares[0] * shares[1] * apart, atol=1e-9
    )
    np.testing.assert_allclose(trace["kalman.weighted.stiffness"], first + 1.1 * second, atol=1e-14)
    for part in ("mass", "damping", "gain"):
        np.testing.assert_allclose(trace[f"kalman.weighted.{part}"], 1.0, atol=1e-14)


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("form", ["recursive", "steady"])
def test_against_an_independent_bank_of_filters(form, seed):
    trace = signals(2500, {"seed": seed, **bank_of(FACTORS, form=form)}, {"added_mass": 0.075})
    states, covariances = reference(trace["sensor.displacement"], trace["drive.voltage"], FACTORS)
    if form == "steady":  # filters of the two forms are the same after some hundred samples
        covariances[:] = covariances[-1]
    settled = slice(0 if form == "recursive" else 600, None)
    for i, what in enumerate(STATES):
        np.testing.assert_allclose(of_bank(trace, what)[settled], states[settled, :, i], atol=1e-9)
    mean, covariance = mixed(of_bank(trace, "probability"), states, covariances)
    state, own = found(trace)
    np.testing.assert_allclose(state[settled], mean[settled], atol=1e-9)
    np.testing.assert_allclose(own[settled], covariance[settled], atol=1e-9)


def test_against_filterpy():
    trace = signals(800, bank_of(FACTORS, kind="imm", process_noise_v=0.1, switching=1e-3), {"stiffness": 0.05})
    filters = []
    for factors in FACTORS.values():
        kalman = KalmanFilter(dim_x=2, dim_z=1, dim_u=1)
        phi, gamma = model(factors)
        kalman.F, kalman.B, kalman.H = phi, gamma, np.array([[1.0, 0.0]])
        kalman.Q, kalman.R = gamma @ gamma.T * 0.01, np.array([[0.0025]])
        kalman.x, kalman.P = np.zeros((2, 1)), np.diag([1.0, K / M * 1e-6])
        filters.append(kalman)
    n = len(filters)
    switching = np.full((n, n), 1e-3 / (n - 1)) + np.eye(n) * (1.0 - 1e-3 - 1e-3 / (n - 1))
    imm = IMMEstimator(filters, np.full(n, 1.0 / n), switching)
    state, covariance = found(trace)
    for i, z in enumerate(trace["sensor.displacement"]):
        if i:
            imm.predict(np.array([[trace["drive.voltage"][i - 1]]]))
        imm.update(np.array([[z]]))
        np.testing.assert_allclose(state[i], imm.x[:, 0], atol=1e-9)
        np.testing.assert_allclose(covariance[i], imm.P, atol=1e-9)
    assert of_bank(trace, "probability")[-1].max() > 0.5


@pytest.mark.parametrize("every", [1, 3])
@pytest.mark.parametrize("kind", ["imm", "reseed", "lock_in", "lock_in_glr", "cusum", "consistency", "two_output"])
def test_every_bank_of_filters_weighs_its_states(kind, every):
    velocimeter = {"sensors": {"velocimeter": {}}} if kind == "two_output" else {}
    trace = signals(900, {"diagnosers": {"kalman": {"kind": kind, "every": every}}, **velocimeter}, {"stiffness": 0.1})
    weights = of_bank(trace, "probability")
    for part, what in zip(("displacement", "velocity"), STATES, strict=True):
        np.testing.assert_allclose(
            trace[f"kalman.weighted.{part}"], (weights * of_bank(trace, what)).sum(axis=1), atol=1e-10
        )
    late = slice(600, None, every)
    for part, name in enumerate(("displacement", "velocity")):
        error = trace[f"kalman.weighted.{name}"] - trace[f"plant.{name}"]
        assert rms(error[late]) < 0.1 * rms(trace[f"plant.{name}"][late]), part


def test_where_a_consistency_test_isolates_its_estimate_is_the_state_of_that_model():
    trace = signals(2000, {"diagnosers": {"kalman": {"kind": "consistency"}}}, {"stiffness": 0.1})
    isolated = trace["kalman.verdict"] == 2
    assert isolated[1000:].all() and np.all(trace["kalman.weighted.stiffness"][isolated] == 1.1)
    for part in ("displacement", "velocity"):
        assert np.array_equal(trace[f"kalman.weighted.{part}"][isolated], trace[f"kalman.state_{part}.k+10"][isolated])


def test_with_two_outputs_the_state_is_corrected_by_both():
    """A second measurement makes the doubt smaller: the covariance is the covariance after both."""
    two = {
        "diagnosers": {"kalman": {"kind": "two_output", "velocity_noise_um_ms": 0.1}},
        "sensors": {"velocimeter": {}},
    }
    one = {"diagnosers": {"kalman": {"kind": "mmae"}}}
    both, alone = (signals(500, values)["kalman.weighted.velocity_std"][-1] for values in (two, one))
    assert both < 0.1 < alone


@pytest.mark.parametrize("every", [1, 4])
@pytest.mark.parametrize("prefilter", [False, True])
@pytest.mark.parametrize("kind", ["self_tuning", "arx_bank"])
def test_a_true_difference_equation_has_the_state_of_the_plant(kind, prefilter, every):
    quiet = {
        "sample_rate_khz": 20 * every,
        "plant": {"model": "linear", "drive_noise_v": 0.0, "thermal_noise": False},
        "sensor": {"kind": "ideal", "noise_um": 0.0},
        "diagnosers": {"kalman": {"kind": kind, "prefilter": prefilter, "every": every}},
    }
    trace = signals(400 * every, quiet)
    late = slice(100 * every, None, every)
    for part in ("displacement", "velocity"):
        own = trace[f"kalman.state_{part}.healthy"][late]
        np.testing.assert_allclose(own, trace[f"plant.{part}"][late], atol=1e-6)
        assert rms(trace[f"kalman.state_{part}.k+10"][late] - own) > 1e-3


@pytest.mark.parametrize("prefilter", [False, True])
def test_a_difference_equation_doubts_its_state_as_much_as_it_errs(prefilter):
    """Without a floor the healthy device has all the probability, so its own covariance is left."""
    bank = {"kind": "arx_bank", "prefilter": prefilter, "probability_floor": 0.0}
    plant = {"model": "linear", "drive_noise_v": 0.0, "thermal_noise": False}
    trace = signals(20_000, {"sample_rate_khz": 20, "plant": plant, "diagnosers": {"kalman": bank}})
    late = slice(500, None)
    assert np.all(trace["kalman.probability.healthy"][late] == 1.0)
    state, covariance = found(trace)
    error = state[late] - np.column_stack([trace["plant.displacement"], trace["plant.velocity"]])[late]
    said = covariance[late].mean(axis=0)
    np.testing.assert_allclose(error.T @ error / len(error), said, rtol=0.05, atol=1e-9)
    assert bool(said[0, 0] == 0.0) == prefilter == bool(said[1, 1] == 0.0)


def test_a_matched_filter_doubts_its_state_as_much_as_it_errs():
    """With the noise there is and no floor, half the squared error over its covariance is 1 on average."""
    squares = []
    for seed in range(1, 7):
        bank = {"kind": "mmae", "process_noise_v": 0.01, "probability_floor": 0.0}
        trace = signals(20_000, {"seed": seed, "diagnosers": {"kalman": bank}})
        state, covariance = found(trace)
        error = (state - np.column_stack([trace["plant.displacement"], trace["plant.velocity"]]))[500:]
        squares.append(0.5 * np.einsum("si,sij,sj->s", error, np.linalg.inv(covariance[500:]), error).mean())
    assert np.mean(squares) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("noise_um", [0.01, 0.2])
def test_the_weighted_state_is_nearer_in_each_of_the_seven_steps_than_the_best_false_model(noise_um):
    """The figures are the errors of the traces, step by step."""
    values = {"sensor.noise_um": noise_um, "metrics.estimation": True}
    result = run(with_values(get("ch5-seven-step"), values), seed=5, taps=True)
    trace, truth = result.trace, result.signal("kalman.truth")
    edges = [0, *(np.flatnonzero(np.diff(truth)) + 1), len(truth)]
    assert len(edges) == 8
    true = trace["plant.displacement"]
    ratios = []
    for start, end in pairwise(edges):
        step = slice(start, end)
        errors = {
            name: rms(trace[f"kalman.state_displacement.{name}"][step] - true[step])
            for i, name in enumerate(NAMES)
            if i != truth[start]
        }
        own = rms(trace["kalman.weighted.displacement"][step] - true[step])
        ratios.append(own / min(errors.values()))
    assert max(ratios) < 0.6
    figures = result.metrics
    assert figures["estimation.kalman.worst_step_ratio"] == pytest.approx(max(ratios), rel=1e-9)
    for part, end in (("displacement", "um"), ("velocity", "um_ms")):
        error = trace[f"kalman.weighted.{part}"] - trace[f"plant.{part}"]
        assert figures[f"estimation.kalman.rms_error_{end}"] == pytest.approx(rms(error), rel=1e-9)
    for i, part in enumerate(("mass", "stiffness", "damping")):
        factors = np.array([FACTORS[NAMES[int(index)]][i] for index in truth])
        error = trace[f"kalman.weighted.{part}"] - factors
        assert figures[f"estimation.kalman.rms_error_{part}_pct"] == pytest.approx(100 * rms(error), rel=1e-9)


def test_figures_of_runs_abreast_are_the_figures_of_runs_alone():
    scenario = with_values(get("ch5-weighted-output"), {"samples": 2500})
    for one in outcomes([(scenario, seed) for seed in range(1, 5)]):
        alone = run(scenario, one.seed, figures_only=True)
        assert one.metrics == alone.metrics and one.digest == alone.digest
        assert sum(name.startswith("estimation.") for name in one.metrics) == 4 * 6


def test_the_mean_of_the_models_is_no_such_estimate():
    """The expectations of the scenario are about the weights: with equal weights they do not hold."""
    scenario = get("ch5-weighted-output")
    result = run(scenario, taps=True)
    assert all(entry["ok"] for entry in result.expectations())
    bounds = {entry.metric: entry for entry in scenario.head.expect}
    for name in ("kalman", "imm"):
        states = [result.signal(f"{name}.state_displacement.{hypothesis}") for hypothesis in NAMES]
        error = rms(np.mean(states, axis=0) - result.signal("plant.displacement"))
        assert bounds[f"estimation.{name}.rms_error_um"].missed_twice(error)
    error = rms(np.mean([factors[1] for factors in FACTORS.values()]) - stiffness_of(result.signal("kalman.truth")))
    assert bounds["estimation.kalman.rms_error_stiffness_pct"].missed_twice(100.0 * error)


def stiffness_of(truth: np.ndarray) -> np.ndarray:
    return np.array([FACTORS[NAMES[int(index)]][1] for index in truth])
