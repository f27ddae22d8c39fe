"""Faults of the measurement: each against its formula, all of them out of reach of the true shuttle."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from tests.lab import RICH, do, make, play, rms

SINE = {"reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 500.0}}
SENSOR = ("sensor_noise", "sensor_bias", "sensor_dropout", "sensor_quantisation", "sensor_hum")


def measured(fault: str, severity: float, ticks: int, **more):
    """Return the measured and the true signal under one fault of a noiseless sensor."""
    board = make({**SINE, **more.pop("values", {})})
    do(board, {"fault": fault, "severity": severity, **more})
    trace = play(board, ticks)
    return trace["sensor.displacement"], trace["plant.displacement"]


def test_noise_is_white_normal_and_as_strong_as_it_says():
    z, x = measured("sensor_noise", 0.3, 40_000)
    noise = (z - x) / 0.3
    assert rms(noise) == pytest.approx(1.0, abs=4 / math.sqrt(2 * len(noise)))
    assert abs(noise.mean()) < 4 / math.sqrt(len(noise))
    assert stats.kstest(noise, "norm").pvalue > 1e-3
    for lag in (1, 2, 200):
        assert abs(np.mean(noise[lag:] * noise[:-lag])) < 4 / math.sqrt(len(noise))


def test_noise_is_independent_of_that_of_the_sensor():
    board = make({**SINE, "sensor.noise_um": 0.3})
    do(board, {"fault": "sensor_noise", "severity": 0.4})
    trace = play(board, 40_000)
    assert rms(trace["sensor.displacement"] - trace["plant.displacement"]) == pytest.approx(0.5, rel=0.02)


def test_bias_and_drift():
    z, x = measured("sensor_bias", -0.7, 300)
    np.testing.assert_allclose(z - x, -0.7, atol=1e-12)
    z, x = measured("sensor_bias", 2.0, 300, profile={"kind": "ramp", "duration_ms": 2.0})
    np.testing.assert_allclose(z - x, np.minimum(np.arange(300) / 200, 1.0) * 2.0, atol=1e-12)


def test_drop_out_holds_the_last_sample_that_came():
    z, x = measured("sensor_dropout", 0.3, 30_000)
    lost = z != x
    lost[np.abs(np.diff(x, prepend=-1.0)) == 0.0] = False
    share = lost[1:].mean()
    assert share == pytest.approx(0.3, abs=4 * math.sqrt(0.3 * 0.7 / len(x)))
    last = np.maximum.accumulate(np.where(lost, 0, np.arange(len(x))))
    np.testing.assert_array_equal(z[1:], x[last][1:])
    # gaps between samples that come are geometric
    gaps = np.diff(np.flatnonzero(~lost))
    for length in (1, 2, 3):
        chance = 0.7 * 0.3 ** (length - 1)
        assert np.mean(gaps == length) == pytest.approx(chance, abs=4 * math.sqrt(chance / len(gaps)))


def test_a_loose_contact_holds_for_as_long_as_it_is_open():
    board = make(SINE)
    play(board, 123)
    do(
        board,
        {
            "fault": "sensor_dropout",
            "severity": 1.0,
            "profile": {"kind": "intermittent", "period_ms": 1.0, "duty": 0.25},
        },
    )
    trace = play(board, 100)
    z, x = trace["sensor.displacement"], trace["plant.displacement"]
    assert np.all(z[:25] == z[0]) and z[0] != x[0]
    np.testing.assert_array_equal(z[25:], x[25:])


def test_quantisation_error_is_evenly_spread_over_a_step():
    z, x = measured("sensor_quantisation", 0.02, 20_000, values={"reference.frequency_hz": 509.0})
    np.testing.assert_allclose(z / 0.02, np.round(z / 0.02), atol=1e-9)
    assert abs(z - x).max() <= 0.01 + 1e-12
    assert rms(z - x) == pytest.approx(0.02 / math.sqrt(12), rel=0.02)
    small, _ = measured("sensor_quantisation", 100.0, 300)
    assert np.all(small == 0.0)


def test_hum_is_a_sine_of_the_mains():
    for frequency, parameters in ((50.0, {}), (150.0, {"frequency_hz": 150.0})):
        z, x = measured("sensor_hum", 0.4, 5000, parameters=parameters)
        np.testing.assert_allclose(z - x, 0.4 * np.sin(2e-5 * np.pi * frequency * np.arange(5000)), atol=1e-9)


def test_they_meet_in_the_order_of_the_chain():
    """Additions come before the converter; the coarser converter counts; samples are lost after it."""
    board = make({**SINE, "sensor.quantum_um": 0.01})
    for fault, severity in (("sensor_bias", 0.1), ("sensor_hum", 0.2), ("sensor_quantisation", 0.5)):
        do(board, {"fault": fault, "severity": severity})
    trace = play(board, 2000)
    hum = 0.2 * np.sin(2e-5 * np.pi * 50 * np.arange(2000))
    seen = np.floor(trace["ideal.displacement"] / 0.5 + (0.1 + hum) / 0.5 + 0.5) * 0.5
    assert np.mean(seen == trace["sensor.displacement"]) > 0.999  # but for ties


@pytest.mark.parametrize("fault", SENSOR)
def test_the_shuttle_does_not_feel_them_but_the_loop_does(fault):
    """In open loop the true motion keeps its bits; a controller that trusts the sensor moves the shuttle."""
    for controller, same in (("open_loop", True), ("pid", False)):
        healthy = make({**SINE, "controller.kind": controller})
        faulty = make({**SINE, "controller.kind": controller})
        do(faulty, {"fault": fault, "severity": 0.5})
        a, b = play(healthy, 1500)["plant.displacement"], play(faulty, 1500)["plant.displacement"]
        assert np.array_equal(a, b) == same


@pytest.mark.parametrize("sensor", ["ideal", "capacitive", "quadrature_kalman", "single_beam"])
def test_every_sensor_can_be_biased(sensor):
    board = make({**SINE, "sensor": {"kind": sensor}})
    do(board, {"fault": "sensor_bias", "severity": 0.5})
    trace = play(board, 200)
    np.testing.assert_allclose(trace["sensor.displacement"] - trace[f"{sensor}.displacement"], 0.5, atol=1e-12)


@pytest.mark.parametrize("fault", SENSOR)
def test_no_hypothesis_is_true_meanwhile(fault):
    board = make({}, base=RICH)
    play(board, 10)
    assert board.value("kalman.truth") == 0
    do(board, {"fault": fault, "severity": 0.1})
    assert np.all(play(board, 50)["kalman.truth"] == -1)
    do(board, {"heal": [fault]})
    assert np.all(play(board, 50)["kalman.truth"] == 0)


def test_pid_follows_what_a_biased_sensor_says():
    """With integral action the mean of the measurement is right, so the mean of the shuttle is off by the bias."""
    board = make({"reference": {"kind": "constant", "amplitude_v": 5.0}, "controller.kind": "pid"})
    play(board, 4000)
    before = board.value("plant.displacement")
    do(board, {"fault": "sensor_bias", "severity": 0.2})
    play(board, 8000)
    assert board.value("plant.displacement") - before == pytest.approx(-0.2, rel=1e-3)
