"""The Kalman bank against filterpy and a bank written here."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest
from filterpy.kalman import KalmanFilter, MMAEFilterBank

from core.plain import plain
from scenarios.campaign.single import run_seeds
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.lab import do, inject, make, phasor, play
from tests.physics.bank import BENCH, BETA, FACTORS, FORCE, NAMES, K, M, model, of_bank, signals

Factors = dict[str, tuple[float, float, float]]


def reference_bank(z: np.ndarray, u: np.ndarray, floor: float, factors: Factors = FACTORS) -> np.ndarray:
    """MMAE in logarithms with a floor, all filters at once."""
    models = [model(own) for own in factors.values()]
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
    values = {"diagnosers.kalman.probability_floor": floor, "diagnosers.kalman.least_drive_v": 0.0}
    scenario = with_values(get("ch5-seven-step"), values)
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


@pytest.mark.parametrize("n", [2, 7, 8, 9, 15, 16])
@pytest.mark.parametrize("kind", ["mmae", "reseed"])
def test_a_list_of_any_length_against_an_independent_bank(n, kind):
    """Models are worked on eight at a time, and there is room for sixteen: no length is special."""
    factors = {f"k{i}": (1.0, 1.0 + 0.02 * i, 1.0) for i in range(n)}
    hypotheses = [{"name": name, "stiffness": own[1]} for name, own in factors.items()]
    bank = {"kind": kind, "hypotheses": hypotheses, "process_noise_v": 0.3, "least_drive_v": 0.0}
    if kind == "reseed":
        bank["sure"] = 1.0  # never seeds
    trace = signals(1200, {"diagnosers": {"kalman": bank}}, {"stiffness": 0.02 * (n - 1)})
    found = of_bank(trace, "probability", list(factors))
    expected = reference_bank(trace["sensor.displacement"], trace["drive.voltage"], 1e-3, factors)
    np.testing.assert_allclose(found, expected, atol=1e-8)
    assert found[-1].argmax() == n - 1


def test_first_probabilities_against_filterpy_bank():
    bank = {"kind": "mmae", "process_noise_v": 0.3, "probability_floor": 0.0, "least_drive_v": 0.0}
    values = {"diagnosers": {"kalman": bank}}
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


def test_seven_steps_over_8_seeds():
    metrics = run_seeds(get("ch5-seven-step"), range(1, 9))["metrics"]
    assert metrics["diagnosis.kalman.correct_fraction"] >= 0.98
    delays = [metrics[f"diagnosis.kalman.delay_samples.{step}"] for step in range(1, 8)]
    assert max(delays) <= 25 and min(delays) >= 1
    assert metrics["diagnosis.kalman.false_switches"] <= 4


def test_without_a_floor_the_bank_locks():
    scenario = with_values(get("ch5-seven-step"), {"diagnosers.kalman.probability_floor": 0})
    found = run_seeds(scenario, range(1, 7))["metrics"]
    assert 0.43 <= found["diagnosis.kalman.correct_fraction"] <= 0.46
    one = run(scenario, 3).board.scores()["kalman"]
    assert one.delays[0] is not None and one.delays[1:6] == [None] * 5


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
    wiring, row = board.wiring, board.wiring.row("kalman")
    bank = wiring.instances[row].block
    s, x = bank.State(wiring.state_of("kalman").copy()), bank.Ports(wiring.w.copy(), wiring.ports(row))
    before = x.probability[:n].copy()
    x.measured = math.nan
    plain(bank.step)(wiring.parameters("kalman"), s, x)
    assert np.all(np.isfinite(s.array)) and np.all(np.isfinite(x.probability[:n]))
    np.testing.assert_allclose(x.probability[:n], before, rtol=0.01)  # the floor is shared out anew


def test_assumed_sensor_noise_follows_the_sensor_unless_given():
    follow = make({**BENCH, "diagnosers": {"kalman": {"kind": "mmae"}}})
    given_ = make({**BENCH, "diagnosers": {"kalman": {"kind": "mmae", "sensor_noise_um": 0.05}}})
    assert np.array_equal(of_bank(play(follow, 300), "probability"), of_bank(play(given_, 300), "probability"))
    other = make({**BENCH, "diagnosers": {"kalman": {"kind": "mmae", "sensor_noise_um": 0.5}}})
    assert not np.array_equal(of_bank(play(other, 300), "probability"), of_bank(play(follow, 300), "probability"))


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


@pytest.mark.parametrize("every", [2, 3, 7])
@pytest.mark.parametrize("kind", ["mmae", "lock_in", "lock_in_glr", "consistency", "cusum", "reseed", "moving_bank"])
def test_a_bank_that_runs_now_and_then_follows_the_voltage_of_every_tick(kind, every):
    """Without noise the true model then predicts to rounding, however often the bank corrects."""
    bench = {
        "plant": {"model": "linear", "drive_noise_v": 0.0, "thermal_noise": False},
        "sensor": {"kind": "ideal", "noise_um": 0.0},
        "reference": {"kind": "multi_sine", "amplitude_v": 5.0},
        "diagnosers": {"slow": {"kind": kind, "every": every, "sensor_noise_um": 0.05}},
    }
    trace = play(make({**BENCH, **bench}), 1500)
    name = "centre" if kind == "moving_bank" else "healthy"
    assert np.max(np.abs(trace["plant.displacement"])) > 0.5
    assert np.max(np.abs(trace[f"slow.residual.{name}"])) < 1e-9


@pytest.mark.parametrize("sensor_every", [2, 3])
@pytest.mark.parametrize("seed", [1, 104])
def test_a_bank_waits_for_a_slower_sensor(sensor_every, seed):
    """An old measurement is no new evidence; with it as evidence, a bank is right a fifth of the time."""
    metrics = run(with_values(get("ch5-seven-step"), {"sensor.every": sensor_every}), seed=seed).metrics
    assert metrics["diagnosis.kalman.correct_fraction"] > 0.97
    assert metrics["diagnosis.kalman.nis"] == pytest.approx(1.0, abs=0.2)


def test_a_bank_follows_a_change_to_a_slower_sensor():
    sensors = {"sensor": {"kind": "ideal"}, "sensors": {"ideal": {"noise_um": 0.05}, "capacitive": {"every": 4}}}
    board = make({**BENCH, **sensors, "device": {"id": "lcr-350"}})
    play(board, 200)
    do(board, {"set": {"sensor.kind": "capacitive"}})
    residual = play(board, 200)["kalman.residual.healthy"]
    assert np.all(np.flatnonzero(np.diff(residual)) % 4 == 3)
    do(board, {"set": {"sensor.kind": "ideal"}})
    assert np.count_nonzero(np.diff(play(board, 200)["kalman.residual.healthy"])) == 199


@pytest.mark.parametrize(
    ("kind", "every", "sensor_every", "is_told"),
    [("self_tuning", 1, 1, False), ("self_tuning", 10, 1, True), ("self_tuning", 1, 10, True), ("mmae", 10, 10, False)],
)
def test_what_weighs_many_ticks_as_the_nominal_device_does_is_told_of(kind, every, sensor_every, is_told):
    """Once for each bank, whichever makes it wait; how much it loses is in `test_voltage`."""
    sensor = {"kind": "ideal", "noise_um": 0.05, "every": sensor_every}
    board = make({**BENCH, "sensor": sensor, "diagnosers": {"slow": {"kind": kind, "every": every}}})
    play(board, 600)
    told = [entry.text for entry in board.log if entry.kind == "warning" and entry.text.startswith("slow weighs")]
    assert len(told) == is_told
    assert all("the voltages of 10 ticks" in text and "of k+10 at 2\u00a0kHz" in text for text in told)


@pytest.mark.parametrize(
    ("rate_khz", "kind", "lost"),
    [
        (20, "parabola", None),
        (500, "middle", None),
        (20, "middle", "1.6 %"),
        (10, "middle", "6.5 %"),
        (20, "start", "31 %"),
    ],
)
def test_a_bank_that_takes_an_analogue_drive_for_held_is_told_of(rate_khz, kind, lost):
    """The middle of a tick is 1 - sin x/x short of a sine of 2 kHz, x = 0.314, 0.628; its start is late by x too."""
    document = {**BENCH, "sample_rate_khz": rate_khz, "plant": {"model": "linear", "drive": "analogue"}}
    board = make({**document, "diagnosers": {"kalman": {"kind": "mmae", "voltage": kind}}})
    play(board, 100)
    told = [entry.text for entry in board.log if entry.kind == "warning" and entry.text.startswith("kalman takes")]
    assert len(told) == (lost is not None)
    assert all(f": {lost} of the drive at 2 kHz" in text.replace("\u00a0", " ") for text in told)
