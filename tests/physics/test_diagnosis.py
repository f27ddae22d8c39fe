"""The Kalman bank against scipy, filterpy and a bank written here; the score against its definition."""

from __future__ import annotations

import itertools
import math
import warnings
from typing import Any

import numpy as np
import pytest
from filterpy.kalman import KalmanFilter, MMAEFilterBank
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm, solve_discrete_are

from core.block import Context, Oscillator
from core.board import score
from core.diagnose.hypothesis import Hypothesis
from core.diagnose.mmae import steady_gain
from core.faults.fault import FaultParams
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from scenarios.seeds import run_seeds
from tests.lab import inject, make, phasor, play

M, BETA, K, FORCE = 2.2090e-10, 7.09e-7, 0.0538, -6.375e-9
FACTORS = {
    "healthy": (1, 1, 1),
    "m+5": (1.05, 1, 1),
    "m+10": (1.1, 1, 1),
    "k+5": (1, 1.05, 1),
    "k+10": (1, 1.1, 1),
    "b+30": (1, 1, 1.3),
}
NAMES = list(FACTORS)
NOMINAL = Oscillator(mass=M * 1e6, damping=BETA * 1e3, stiffness=K, force=FORCE * 1e6)
BENCH: dict[str, Any] = {
    "sample_rate_khz": 50,
    "device": {"id": "ch3", "force_n_per_v": 6.375e-9, "bias_v": 6.0},
    "plant": {"model": "linear", "drive_noise_v": 0.010, "thermal_noise": False},
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 2000.0},
    "sensor": {"kind": "ideal", "noise_um": 0.05},
    "diagnosers": {"kalman": {"kind": "mmae", "process_noise_v": 0.3}},
}


def model(factors: tuple[float, float, float], dt: float = 0.02) -> tuple[np.ndarray, np.ndarray]:
    """Discrete model under a held voltage, um, ms, V."""
    m, k, b = factors
    a = np.array([[0, 1, 0], [-K * k / (M * m) * 1e-6, -BETA * b / (M * m) * 1e-3, FORCE / (M * m)], [0, 0, 0]])
    block = expm(a * dt)
    return block[:2, :2], block[:2, 2:]


def signals(n: int, values: dict[str, Any] | None = None, faults: dict[str, float] | None = None):
    board = make({**BENCH, **(values or {})})
    inject(board, **(faults or {}))
    return play(board, n)


def of_bank(trace: dict[str, np.ndarray], what: str, names: list[str] = NAMES) -> np.ndarray:
    return np.column_stack([trace[f"kalman.{what}.{name}"] for name in names])


# -- one filter


def test_steady_gain_has_the_figures_of_the_riccati_equation():
    phi, gamma = model(FACTORS["healthy"])
    q, r = 0.3**2, 0.05**2
    k1, k2, psi = steady_gain(tuple(phi.ravel()), tuple(gamma[:, 0]), q, r, False)
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


# -- the bank


def reference_bank(z: np.ndarray, u: np.ndarray, floor: float) -> np.ndarray:
    """MMAE in logarithms with a floor, all filters at once."""
    models = [model(factors) for factors in FACTORS.values()]
    phi, gamma = np.array([m[0] for m in models]), np.array([m[1][:, 0] for m in models])
    n = len(models)
    x, p = np.zeros((n, 2)), np.tile(np.diag([1.0, K / M * 1e-6]), (n, 1, 1))
    noise = 0.09 * gamma[:, :, None] * gamma[:, None, :]
    log = np.full(n, -math.log(n))
    out = np.empty((len(z), n))
    for i, value in enumerate(z):
        if i:
            x = np.einsum("nij,nj->ni", phi, x) + gamma * u[i - 1]
            p = phi @ p @ phi.transpose(0, 2, 1) + noise
        residual = value - x[:, 0]
        psi = p[:, 0, 0] + 0.0025
        gain = p[:, :, 0] / psi[:, None]
        x = x + gain * residual[:, None]
        p = p - gain[:, :, None] * p[:, :1, :]
        log = log - 0.5 * residual**2 / psi - 0.5 * np.log(2 * np.pi * psi)
        log = log - np.logaddexp.reduce(log)
        if floor:
            weight = np.maximum(np.exp(log), floor)
            log = np.log(weight / weight.sum())
        out[i] = np.exp(log)
    return out


@pytest.mark.parametrize("floor", [1e-3, 0.0])
def test_probabilities_against_an_independent_bank(floor):
    scenario = with_values(get("ch5-seven-step"), {"diagnosers.kalman.probability_floor": floor})
    result = run(scenario, seed=11)
    names = [item["name"] for item in scenario.document["diagnosers"]["kalman"]["hypotheses"]]
    assert names == NAMES
    found = np.column_stack([result.signal(f"kalman.probability.{name}") for name in NAMES])
    expected = reference_bank(result.signal("sensor.displacement"), result.signal("drive.voltage"), floor)
    assert len(found) == 9000
    np.testing.assert_allclose(found, expected, atol=1e-8)
    assert found.min() >= floor / (1 + 6 * floor)
    np.testing.assert_allclose(found.sum(axis=1), 1.0, atol=1e-12)
    assert np.array_equal(result.signal("kalman.winner"), found.argmax(axis=1))


def test_first_probabilities_against_filterpy_bank():
    values = {"diagnosers": {"kalman": {"kind": "mmae", "process_noise_v": 0.3, "probability_floor": 0.0}}}
    trace = signals(60, values, {"stiffness": 0.05})
    filters = []
    for factors in FACTORS.values():
        kalman = KalmanFilter(dim_x=2, dim_z=1, dim_u=1)
        phi, gamma = model(factors)
        kalman.F, kalman.B, kalman.H = phi, gamma, np.array([[1.0, 0.0]])
        kalman.Q, kalman.R = gamma @ gamma.T * 0.09, np.array([[0.0025]])
        kalman.x, kalman.P = np.zeros((2, 1)), np.diag([1.0, K / M * 1e-6])
        filters.append(kalman)
    bank = MMAEFilterBank(filters, [1 / 6] * 6, dim_x=2, H=filters[0].H)
    found = of_bank(trace, "probability")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for i, z in enumerate(trace["sensor.displacement"]):
            if i:
                bank.predict(u=np.array([[trace["drive.voltage"][i - 1]]]))
            bank.update(np.array([[z]]))
            np.testing.assert_allclose(found[i], bank.p, atol=1e-10)
    assert found[-1].max() > 0.3


def test_printed_residual_covariance_is_worse():
    base = with_values(get("ch5-seven-step"), {"sensor.noise_um": 0.4})
    printed = with_values(base, {"diagnosers.kalman.residual_covariance": "printed"})
    right, wrong = (
        np.mean([run(case, seed).metrics["diagnosis.kalman.correct_fraction"] for seed in range(1, 6)])
        for case in (base, printed)
    )
    assert right > 0.94 and wrong <= 0.45


@pytest.mark.parametrize("form", ["recursive", "steady"])
@pytest.mark.parametrize("covariance", ["correct", "printed"])
def test_a_bank_without_assumed_noise_stays_finite(form, covariance):
    bank = {"kind": "mmae", "process_noise_v": 0.0, "form": form, "residual_covariance": covariance}
    trace = signals(40_000, {"diagnosers": {"kalman": bank}})
    found = of_bank(trace, "probability")
    assert np.all(np.isfinite(found)) and np.all(np.isfinite(of_bank(trace, "nis")))
    np.testing.assert_allclose(found.sum(axis=1), 1.0, atol=1e-9)


def seven_steps(seeds: range) -> dict[str, float]:
    return run_seeds(get("ch5-seven-step"), seeds)["metrics"]


def check_seven_steps(metrics: dict[str, float]) -> None:
    assert metrics["diagnosis.kalman.correct_fraction"] >= 0.98
    delays = [metrics[f"diagnosis.kalman.delay_samples.{step}"] for step in range(1, 8)]
    assert max(delays) <= 25 and min(delays) >= 1
    assert metrics["diagnosis.kalman.false_switches"] <= 4


def test_seven_steps_over_8_seeds():
    check_seven_steps(seven_steps(range(1, 9)))


@pytest.mark.slow
def test_seven_steps_over_50_seeds():
    metrics = seven_steps(range(101, 151))
    check_seven_steps(metrics)
    assert metrics["diagnosis.kalman.correct_fraction"] == pytest.approx(0.990, abs=0.003)
    delays = [metrics[f"diagnosis.kalman.delay_samples.{step}"] for step in range(2, 8)]
    assert all(8 <= delay <= 17 for delay in delays)
    assert metrics["diagnosis.kalman.false_switches"] == pytest.approx(1.2, abs=0.6)


def test_without_a_floor_the_bank_locks():
    scenario = with_values(get("ch5-seven-step"), {"diagnosers.kalman.probability_floor": 0})
    found = run_seeds(scenario, range(1, 7))["metrics"]
    assert 0.43 <= found["diagnosis.kalman.correct_fraction"] <= 0.46
    one = run(scenario, 3).board.scores()["kalman"]
    assert one.delays[0] is not None and one.delays[1:6] == [None] * 5


@pytest.mark.slow
def test_noise_stated_wrongly():
    def mean(values: dict[str, Any], metric: str) -> float:
        return run_seeds(with_values(get("ch5-seven-step"), values), range(1, 41))["metrics"][metric]

    over, just = (
        [
            mean(
                {"sensor.noise_um": 0.6, "diagnosers.kalman.assumed_noise_scale": scale},
                f"diagnosis.kalman.delay_samples.{step}",
            )
            for step in (2, 3, 5, 4)
        ]
        for scale in (1.35, 1.0)
    )
    assert sum(over[:3]) / sum(just[:3]) >= 1.12 and over[3] / just[3] <= 1.15
    under, right = (
        mean(
            {"sensor.noise_um": 0.2, "diagnosers.kalman.assumed_noise_scale": scale}, "diagnosis.kalman.false_switches"
        )
        for scale in (0.6, 1.0)
    )
    assert 8 <= under / right <= 30


def test_phasors_of_the_hypotheses():
    def phasor_of(factors: tuple[float, float, float]) -> complex:
        phi, gamma = model(factors)
        z = np.exp(2j * np.pi * 2.0 * 0.02)
        return -(np.linalg.solve(z * np.eye(2) - phi, gamma)[0, 0]) * 10

    w = 2 * np.pi * 2e3
    continuous = -FORCE * 10e6 / (K - M * w**2 + 1j * BETA * w)
    assert abs(continuous) == pytest.approx(3.049, rel=5e-3)
    assert np.degrees(np.angle(continuous)) == pytest.approx(-25.2, abs=0.3)
    hold = phasor_of(FACTORS["healthy"]) / continuous
    assert abs(hold) == pytest.approx(np.sinc(0.04), abs=0.003)
    assert np.degrees(np.angle(hold)) == pytest.approx(-7.2, abs=0.1)
    x = signals(3000, {"sensor.noise_um": 0.0, "plant.drive_noise_v": 0.0})["plant.displacement"][2000:]
    found = phasor(x, 2000.0, 0.02, 2000)
    assert abs(found + phasor_of(FACTORS["healthy"])) < 1e-3 * abs(found)


def test_a_dropped_measurement_only_widens_the_filter():
    """Not a number from the sensor is skipped, not swallowed."""
    n = len(NAMES)
    board = make(BENCH)
    play(board, 200)
    bank = board.wiring.instances[board.wiring.row("kalman")]
    context = board.spec.context()
    p, s = bank.block.pack(bank.params, context), board.wiring.state_of("kalman").copy()
    w = board.wiring.w.copy()
    row = board.wiring.row("kalman")
    start, end = board.wiring.table[row, 3], board.wiring.table[row + 1, 3]
    io = board.wiring.io[start:end]
    before = w[io[3] : io[3] + n].copy()
    w[io[0]] = math.nan
    bank.block.step(p, s, w, io)
    assert np.all(np.isfinite(s)) and np.all(np.isfinite(w[io[3] : io[3] + n]))
    np.testing.assert_allclose(w[io[3] : io[3] + n], before, rtol=0.01)  # the floor is shared out anew


def test_assumed_sensor_noise_follows_the_sensor_unless_given():
    follow = make({**BENCH, "diagnosers": {"kalman": {"kind": "mmae"}}})
    given_ = make({**BENCH, "diagnosers": {"kalman": {"kind": "mmae", "sensor_noise_um": 0.05}}})
    assert np.array_equal(of_bank(play(follow, 300), "probability"), of_bank(play(given_, 300), "probability"))
    other = make({**BENCH, "diagnosers": {"kalman": {"kind": "mmae", "sensor_noise_um": 0.5}}})
    assert not np.array_equal(of_bank(play(other, 300), "probability"), of_bank(play(follow, 300), "probability"))


# -- every other tick


@pytest.mark.parametrize("every", [2, 3])
def test_a_slower_bank_still_finds_the_fault(every):
    bank = {"kind": "mmae", "process_noise_v": 0.3, "every": every}
    board = make({**BENCH, "sample_rate_khz": 100, "diagnosers": {"kalman": bank}})
    play(board, 600)
    inject(board, stiffness=0.10)
    trace = play(board, 1200)
    assert NAMES[int(trace["kalman.winner"][-1])] == "k+10"
    winner = trace["kalman.winner"]
    assert np.mean(winner[400:] == 4) > 0.97
    changes = np.flatnonzero(np.diff(winner)) + 601
    assert np.all(changes % every == 0)


def test_delay_of_a_slower_bank_counts_from_the_change():
    """A verdict that is right at once has no delay, however seldom it is asked for."""
    board = make(
        {
            **BENCH,
            "sensor.noise_um": 0.0,
            "plant.drive_noise_v": 0.0,
            "diagnosers": {
                "kalman": {"kind": "mmae", "every": 2, "hypotheses": [{"name": "a"}, {"name": "b", "mass": 2}]}
            },
        }
    )
    trace = play(board, 200)
    right = trace["kalman.winner"] == trace["kalman.truth"]
    first = int(np.argmax(right))
    assert np.all(right[first:])
    assert board.scores()["kalman"].delays == [first]


# -- the score


def by_definition(winner: np.ndarray, truth: np.ndarray) -> tuple[float, int, list[int | None]]:
    """Share of right samples; exits from the truth once found; delay to the first of 20 right in a row."""
    edges = [0, *(np.flatnonzero(np.diff(truth)) + 1), len(truth)]
    delays: list[int | None] = []
    exits = 0
    for start, end in itertools.pairwise(edges):
        right = winner[start:end] == truth[start:end]
        found = next((i for i in range(len(right) - 19) if right[i : i + 20].all()), None)
        delays.append(found)
        if found is not None:
            after = right[found:]
            exits += int(np.sum(after[:-1] & ~after[1:]))
    return float(np.mean(winner == truth)), exits, delays


@given(data=st.data())
def test_score_against_its_definition(data):
    factors = [(1.0, 1.0, 1.0), (1.05, 1.0, 1.0), (1.0, 1.1, 1.0)]
    params = score.Score.Params(
        hypotheses=[Hypothesis(name=str(i), mass=m, stiffness=k, damping=b) for i, (m, k, b) in enumerate(factors)]
    )
    random = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    winner, truth = [], []
    for _ in range(data.draw(st.integers(1, 6))):
        now = int(random.integers(-1, 3))
        length = int(random.integers(1, 120))
        wrong = random.random(length) < random.choice([0.0, 0.02, 0.1, 0.5])
        wrong[: random.integers(0, 40)] = True
        verdict = np.where(wrong, (now + random.integers(1, 3, length)) % 3, max(now, 0))
        winner += verdict.tolist()
        truth += [now] * length
    context = Context(dt_ms=0.01, every=1, seed=0, device=NOMINAL, model=NOMINAL)
    p, s = score.Score.pack(params, context), score.Score.state(params, context)
    w = np.zeros(32)
    w[16] = 1.0
    # probability, nis, three scales, drive gain, other, outputs, taps
    io = np.array([2, 5, 8, 9, 10, 16, 17, 11, 12, 13, 14, 15])
    for tick, (who, what) in enumerate(zip(winner, truth, strict=True)):
        w[0] = tick
        w[2:5] = 0.1
        w[2 + who] = 0.8
        w[8:11] = factors[what] if what >= 0 else (1.3, 1.0, 1.0)
        score.Score.step(p, s, w, io)
        assert w[11] == who and w[12] == what
    found = score.read(s, ["0", "1", "2"], winner[-1])
    share, exits, delays = by_definition(np.array(winner), np.array(truth))
    assert found.correct_fraction == pytest.approx(share)
    assert found.false_switches == exits
    assert found.delays == delays
    confusion = np.zeros((3, 3), int)
    for who, what in zip(winner, truth, strict=True):
        if what >= 0:
            confusion[what, who] += 1
    assert found.confusion == confusion.tolist()


def test_scenario_scores_against_their_definition():
    result = run(get("ch5-seven-step"), seed=5)
    winner, truth = result.signal("kalman.winner"), result.signal("kalman.truth")
    expected = np.repeat([0, 1, 2, 3, 4, 5, 0], [2000, 1000, 1000, 1000, 1000, 1000, 2000])
    assert np.array_equal(truth, expected)
    share, exits, delays = by_definition(winner, truth)
    metrics = result.metrics
    assert metrics["diagnosis.kalman.correct_fraction"] == share
    assert metrics["diagnosis.kalman.false_switches"] == exits
    assert [metrics[f"diagnosis.kalman.delay_samples.{i}"] for i in range(1, 8)] == delays
    assert metrics["diagnosis.kalman.mean_delay_samples"] == pytest.approx(np.mean(delays[1:]))
    found = [entry for entry in result.board.log if entry.kind == "recognised"]
    assert [entry.old for entry in found] == delays
    assert [entry.tick for entry in result.board.log if entry.kind == "truth_changed"] == [
        0, 2000, 3000, 4000, 5000, 6000, 7000,
    ]  # fmt: skip


def test_truth_needs_all_factors_and_is_none_otherwise():
    assert FaultParams().severity == 0.0
    trace = signals(50, faults={"added_mass": 0.07})
    assert np.all(trace["kalman.truth"] == -1)
    both = signals(50, faults={"added_mass": 0.05, "stiffness": 0.05})
    assert np.all(both["kalman.truth"] == -1)
    assert np.all(signals(50, faults={"damping": 0.3})["kalman.truth"] == 5)


def test_a_hypothesis_on_the_drive_is_not_the_truth_of_a_healthy_device():
    bank = {"kind": "mmae", "hypotheses": [{"name": "gain+10", "gain": 1.1}, {"name": "healthy"}]}
    trace = play(make({**BENCH, "diagnosers": {"kalman": bank}}), 400)
    assert np.all(trace["kalman.truth"] == 1)
    assert trace["kalman.correct_fraction"][-1] > 0.9
