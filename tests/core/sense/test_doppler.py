from __future__ import annotations

import numpy as np

from core.sense.doppler import Doppler
from core.sense.grating import Grating, series
from tests.core.sense.bench import TICKS, make
from tests.lab import play

BOTH = {
    "sensors.doppler.always": True,
    "sensors.doppler.noise_um_ms": 0.0,
    "sensors.doppler.leak_ms": 1e6,
    "sensors.through_wafer.always": True,
    "sensors.through_wafer.snr_db": 200.0,
}


def test_integral_of_the_signal_is_the_intensity():
    # h = d (1 - o) and I = T + (1 - T) o: both are the same function of displacement
    board = make(BOTH)
    trace = play(board, 3000)
    signal, light = trace["doppler.velocity"], trace["through_wafer.intensity"]
    integral = np.concatenate([[0.0], np.cumsum(0.5 * (signal[1:] + signal[:-1]))]) * board.dt_ms
    expected = -2.0 / 0.5 * (light - light[0])
    np.testing.assert_allclose(integral, expected, atol=2e-3)
    assert np.ptp(expected) > 1.2
    np.testing.assert_allclose(trace["doppler.height"] - trace["doppler.height"][0], expected, atol=2e-3)


def test_the_height_begins_where_the_beam_is():
    """Of a shuttle that starts at speed: nothing has been integrated yet, then the trapezoids between samples."""
    moving = {"plant.initial_velocity_um_ms": 40.0, "plant.initial_displacement_um": 0.7}
    offset = {f"sensors.{name}.grating_offset_um": 0.0 for name in ("doppler", "through_wafer")}
    board = make({**BOTH, **moving, **offset, "sample_rate_khz": 50.0})
    trace = play(board, 40)
    # h = d (1 - o) of a grating half open, smoothed by a beam of 1.5 um: o = 1/2 + sum a_m cos(2 pi m x / L)
    m = np.arange(1, 40)
    harmonics = 2 / (np.pi * m) * np.sin(np.pi * m / 2) * np.exp(-0.5 * (np.pi * m * 1.5 / 4) ** 2)
    first = 2.0 * (0.5 - np.sum(harmonics * np.cos(2 * np.pi * m * 0.7 / 4)))
    signal = trace["doppler.velocity"]
    expected = first + np.concatenate([[0.0], np.cumsum(0.5 * (signal[1:] + signal[:-1])) * board.dt_ms])
    np.testing.assert_allclose(trace["doppler.height"], expected, atol=1e-4)


def test_reflected_motion_gives_the_same_signal():
    p = Doppler.Params(grating_offset_um=0.3).packed(Grating, make().spec.context())
    for x in np.linspace(-3, 3, 13):
        for extreme in (0.3, 2.3):
            assert abs(series(p, x)[1] * 7.0 - series(p, 2 * extreme - x)[1] * -7.0) < 1e-12


def test_eight_pulses_a_cycle_as_high_as_the_shuttle_is_fast():
    trace = play(make({**BOTH, "sensors.doppler.grating_offset_um": 0.0}), TICKS)
    cycle = slice(TICKS_LAST_CYCLE, None)
    signal = trace["doppler.velocity"][cycle]
    pulses = np.sum((np.diff(np.sign(np.diff(signal))) != 0) & (np.abs(signal[1:-1]) > 5.0))
    assert pulses == 8
    # the fundamental alone: d (2/pi) exp(-(pi w/L)^2/2) (2 pi/L) at the full speed of 50 um/ms
    peak = (
        2.0
        * 2
        / np.pi
        * np.exp(-((np.pi * 1.5 / 4) ** 2) / 2)
        * np.pi
        / 2
        * np.abs(trace["plant.velocity"][cycle]).max()
    )
    assert 0.8 * peak < np.abs(signal).max() <= 1.02 * peak


TICKS_LAST_CYCLE = -259
