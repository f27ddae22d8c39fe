from __future__ import annotations

import math

import numpy as np
import pytest

from tests.core.sense.bench import TICKS, errors, make, rms_nm
from tests.lab import do, play

PAIR = {"sensor.kind": "quadrature"}


def closed_form_nm(snr_db: float) -> float:
    return 4000.0 / (2 * math.pi * math.sqrt(2)) * 10 ** (-snr_db / 20)


def check_at_30_db(seeds: range) -> None:
    error = errors(PAIR, seeds)
    assert np.abs(error).max() < 2.0, "slipped"
    assert rms_nm(error) == pytest.approx(14.2, rel=0.08)


def test_14_nm_at_30_db_and_no_slips():
    check_at_30_db(range(1, 11))


@pytest.mark.long
def test_14_nm_at_30_db_and_no_slips_in_a_hundred_runs():
    check_at_30_db(range(1, 101))


@pytest.mark.parametrize("snr_db", [40.0, 20.0, 15.0])
def test_error_follows_the_noise(snr_db):
    error = errors({**PAIR, "sensors.dual_beam.snr_db": snr_db}, range(1, 3))
    assert rms_nm(error) == pytest.approx(closed_form_nm(snr_db), rel=0.05)


@pytest.mark.parametrize("kind", ["quadrature", "quadrature_kalman"])
@pytest.mark.parametrize("spacing", [1.0, 0.5, 1.7])
def test_filters_are_told_the_noise(kind, spacing):
    """The sine of the phase is (second - cos d first) / sin d: beams close together amplify the noise."""
    apart = {"sensors.dual_beam.spacing_um": spacing, "sensors.quadrature.spacing_um": spacing}
    context = make({"sensor.kind": kind, "sensors.dual_beam.snr_db": 25.0, **apart}).spec.context()
    amplified = closed_form_nm(25.0) / abs(math.sin(2 * math.pi * spacing / 4.0))
    assert context.sensor_noise_um == pytest.approx(amplified / 1e3)


@pytest.mark.parametrize("spacing", [0.5, 1.3])
def test_the_noise_told_is_the_noise_there_is(spacing):
    """The mean over a pitch of the phase error of two detectors, and the residuals of a bank that knows it."""
    apart = {"sensors.dual_beam.spacing_um": spacing, "sensors.quadrature.spacing_um": spacing}
    bank = {"kind": "mmae", "process_noise_v": 0.01, "hypotheses": [{"name": "healthy"}, {"name": "m", "mass": 2.0}]}
    values = {**PAIR, **apart, "sensors.dual_beam.spot_um": 2.0, "sensors.dual_beam.snr_db": 40.0}
    board = make({**values, "diagnosers": {"kalman": bank}})
    trace = play(board, TICKS)
    error = trace["sensor.displacement"] - trace["plant.displacement"]
    told = board.spec.context().sensor_noise_um
    assert np.sqrt(np.mean(error[2000:] ** 2)) == pytest.approx(told, rel=0.05)
    assert trace["kalman.nis.healthy"][2000:].mean() == pytest.approx(1.0, rel=0.1)


def test_spacing_error_makes_an_ellipse_and_knowing_it_mends_it():
    # tan of the phase is sheared by 9 degrees: peak error about Lambda/(2 pi) 9 deg / 2 = 50 nm
    off = {**PAIR, "sensors.dual_beam.spacing_um": 1.1, "sensors.dual_beam.snr_db": 200.0}
    centred = errors(off, range(1, 2))
    assert 0.5 * np.ptp(centred) == pytest.approx(0.050, rel=0.15)
    assert np.abs(errors({**off, "sensor.spacing_um": 1.1}, range(1, 2))).max() < 0.002


def test_taking_over_keeps_the_fringe():
    board = make({"sensor.kind": "ideal"})
    play(board, 3210)
    assert abs(board.value("plant.displacement")) > 2.5
    do(board, {"set": {"sensor.kind": "quadrature"}})
    trace = play(board, 1000)
    assert np.abs(trace["sensor.displacement"] - trace["plant.displacement"]).max() < 0.1


def test_kalman_filter_is_better_and_does_not_slip():
    error = errors({"sensor.kind": "quadrature_kalman"}, range(1, 6))
    assert np.abs(error).max() < 0.2
    assert rms_nm(error) < 9.3 * 1.05
    noisy = errors({"sensor.kind": "quadrature_kalman", "sensors.dual_beam.snr_db": 10.0}, range(1, 6))
    assert np.abs(noisy).max() < 2.0, "slipped"
    assert rms_nm(noisy) < 71.0


def test_kalman_filter_bears_a_wrong_stiffness():
    error = errors({"sensor.kind": "quadrature_kalman"}, range(1, 4), stiffness=-0.10)
    assert np.abs(error).max() < 0.5
    assert rms_nm(error) < closed_form_nm(30.0)
